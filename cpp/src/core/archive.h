// Archives: named arrays in one file, which is mapped into memory and used where it lies.
//
//     header    48 bytes: magic, byte order, format version, size of the file, sections, digest
//     table     88 bytes a section: name, where, how long, size of an element, digest
//     sections  each on a multiple of 64 bytes, one after the other
//
// Nothing in a file is believed. Opening checks the header, and the table against the file's size, so every
// array lies inside the file; verify() compares all contents with their digests. What the numbers mean is for
// whoever reads them to check, since a digest can be forged.
//
// A mapped file must not be cut short by another program. ArchiveWriter never does: it writes a new file
// beside the old one and puts it in its place when all is there, so that whoever has the old one open keeps it.
#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/digest.h"
#include "decalgl/core/progress.h"
#include "decalgl/core/shared_array.h"

namespace decalgl {

// Goes up with every change of what the sections of a prepared scene hold or mean, also when the same scene
// comes to be prepared in another way. Files of other versions are refused, and caches made anew.
constexpr uint32_t archive_format = 5;

constexpr size_t archive_name_bytes = 48;
constexpr size_t archive_alignment = 64;

struct ArchiveHeader {
    std::array<char, 8> magic;
    uint32_t byte_order;
    uint32_t format;
    uint64_t file_bytes;
    uint64_t section_count;
    Digest digest;  // of the header up to here and of the table
};
static_assert(sizeof(ArchiveHeader) == 48 && std::is_trivially_copyable_v<ArchiveHeader>, "as in the file");

struct ArchiveSection {
    std::array<char, archive_name_bytes> name;  // ends with 0
    uint64_t offset;
    uint64_t bytes;
    uint64_t element_bytes;
    Digest digest;
};
static_assert(sizeof(ArchiveSection) == 88 && std::is_trivially_copyable_v<ArchiveSection>, "as in the file");

class ArchiveWriter {
public:
    // Values that stay where they are until write(). Names are shorter than 48 characters and given once.
    template <typename T>
    void add(const std::string& name, Span<const T> values) {
        static_assert(alignof(T) <= archive_alignment, "sections lie on multiples of 64 bytes");
        add_section(name, bytes_of(values), sizeof(T));
    }

    // Small values, which are copied. A struct has no padding, as its bytes go into the file.
    template <typename T>
    void add_copy(const std::string& name, Span<const T> values) {
        copies_.emplace_back(bytes_of(values).begin(), bytes_of(values).end());
        add_section(name, copies_.back(), sizeof(T));
    }
    template <typename T>
    void add_value(const std::string& name, const T& value) {
        add_copy(name, Span<const T>(&value, 1));
    }
    void add_text(const std::string& name, const std::string& text) {
        add_copy(name, Span<const char>(text.data(), text.size()));
    }

    // Puts a file of all sections in place of `path`; what was there stays until all is written, and where
    // writing fails. Throws Error(file), Error(cancelled).
    void write(const std::string& path, unsigned threads, Progress& progress) const;

    // Throws Error(file) where write() could not even begin: to be asked before long work.
    static void require_writable(const std::string& path);

private:
    struct Section {
        std::string name;
        Span<const uint8_t> bytes;
        size_t element_bytes;
    };

    void add_section(const std::string& name, Span<const uint8_t> bytes, size_t element_bytes);

    std::vector<Section> sections_;
    std::vector<std::vector<uint8_t>> copies_;
};

class ArchiveReader {
public:
    // Maps a file and checks its header and its table. Throws Error(file).
    explicit ArchiveReader(const std::string& path);

    // Whether a file begins as an archive does, whatever follows.
    static bool is_archive(const std::string& path);

    // Compares every section with its digest, on all cores. Throws Error(file).
    void verify(unsigned threads) const;

    // The values of a section, where they lie in the file; they keep the mapping alive. Throws Error(file)
    // where there is no such section or its elements have another size.
    template <typename T>
    SharedArray<T> array(const std::string& name) const {
        static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= archive_alignment, "plain data alone");
        const ArchiveSection& section = find(name, sizeof(T));
        const auto* values = reinterpret_cast<const T*>(file_.data() + section.offset);
        return {Span<const T>(values, section.bytes / sizeof(T)), file_.storage()};
    }

    // A section of one element.
    template <typename T>
    T value(const std::string& name) const {
        const SharedArray<T> values = array<T>(name);
        if (values.size() != 1)
            refuse("section '" + name + "' does not hold one value");
        return values[0];
    }
    std::string text(const std::string& name) const {
        const SharedArray<char> characters = array<char>(name);
        return {characters.begin(), characters.end()};
    }

    const std::string& path() const { return path_; }
    uint64_t file_bytes() const { return file_.size(); }
    Span<const ArchiveSection> sections() const { return sections_; }

    // Throws Error(file): this file is damaged in the way that `what` says, and what to do.
    [[noreturn]] void refuse(const std::string& what) const;

private:
    void check_header();
    void check_table();
    const ArchiveSection& find(const std::string& name, size_t element_bytes) const;

    std::string path_;
    SharedArray<uint8_t> file_;  // mapped
    Span<const ArchiveSection> sections_;
    std::map<std::string_view, const ArchiveSection*> by_name_;
};

}  // namespace decalgl

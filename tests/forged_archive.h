// Archives that have been tampered with, whose digests fit all the same.
#pragma once

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <unistd.h>

#include "core/archive.h"

namespace decalgl::test {

using Bytes = std::vector<uint8_t>;

// A folder of its own that goes when the test ends.
class ScratchFolder {
public:
    ScratchFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "decalgl-test-XXXXXX").string();
        path_ = ::mkdtemp(pattern.data());
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    ~ScratchFolder() { std::filesystem::remove_all(path_); }

    std::string file(const std::string& name) const { return (path_ / name).string(); }
    size_t count() const {
        const std::filesystem::directory_iterator entries(path_);
        return static_cast<size_t>(std::distance(begin(entries), end(entries)));
    }

private:
    std::filesystem::path path_;
};

inline Bytes read_file(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return Bytes(std::istreambuf_iterator<char>(file), {});
}

inline void write_file(const std::string& path, const Bytes& bytes) {
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

// The parts of an archive in memory, to be changed.
struct OpenArchive {
    ArchiveHeader header{};
    std::vector<ArchiveSection> table;
    Bytes rest;  // what follows the table

    explicit OpenArchive(const Bytes& bytes) {
        std::memcpy(&header, bytes.data(), sizeof(header));
        table.resize(header.section_count);
        std::memcpy(table.data(), bytes.data() + sizeof(header), table.size() * sizeof(ArchiveSection));
        rest.assign(bytes.begin() + static_cast<std::ptrdiff_t>(head_bytes()), bytes.end());
    }

    size_t head_bytes() const { return sizeof(header) + table.size() * sizeof(ArchiveSection); }

    // The contents of a section, which lies where the table says.
    Span<uint8_t> contents(size_t section) {
        return {rest.data() + table[section].offset - head_bytes(), table[section].bytes};
    }

    void sign_sections() {
        for (size_t i = 0; i < table.size(); ++i)
            table[i].digest = digest_of(Span<const uint8_t>(contents(i)), 1);
    }

    // The file, with a head whose digest fits.
    Bytes bytes() {
        header.digest = {};
        DigestBuilder builder(1);
        builder.add_value(header);
        builder.add(Span<const ArchiveSection>(table));
        header.digest = builder.finish();
        Bytes result(head_bytes());
        std::memcpy(result.data(), &header, sizeof(header));
        std::memcpy(result.data() + sizeof(header), table.data(), table.size() * sizeof(ArchiveSection));
        result.insert(result.end(), rest.begin(), rest.end());
        return result;
    }
};

// Changes a few bytes of the contents to values that often hurt, and signs them.
inline Bytes forge_contents(const Bytes& original, std::mt19937& random) {
    OpenArchive archive(original);
    const auto below = [&](size_t count) { return random() % count; };
    for (size_t changes = 1 + below(4); changes > 0; --changes) {
        const Span<uint8_t> contents = archive.contents(below(archive.table.size()));
        if (contents.empty())
            continue;
        const uint8_t values[] = {0, 1, 0x7F, 0x80, 0xFF, static_cast<uint8_t>(random())};
        const size_t at = below(contents.size());
        const size_t count = std::min<size_t>(contents.size() - at, size_t{1} << below(4));
        std::fill_n(contents.begin() + at, count, values[below(6)]);
    }
    archive.sign_sections();
    return archive.bytes();
}

}  // namespace decalgl::test

#include "core/archive.h"

#include <algorithm>
#include <cstring>

#include "core/mapped_file.h"
#include "decalgl/core/error.h"

namespace decalgl {
namespace {

constexpr std::array<char, 8> magic{'D', 'E', 'C', 'A', 'L', 'G', 'L', '\0'};
constexpr uint32_t native_byte_order = 0x01020304;
constexpr size_t most_sections = 1 << 16;
constexpr size_t write_bytes = size_t{16} << 20;

constexpr size_t aligned(size_t bytes) {
    return (bytes + archive_alignment - 1) / archive_alignment * archive_alignment;
}

Digest digest_of_head(const ArchiveHeader& header, Span<const ArchiveSection> table) {
    ArchiveHeader without_digest = header;
    without_digest.digest = {};
    DigestBuilder builder(1);
    builder.add_value(without_digest);
    builder.add(table);
    return builder.finish();
}

std::string_view name_of(const ArchiveSection& section) {
    return {section.name.data(), ::strnlen(section.name.data(), section.name.size())};
}

bool is_plain(char letter) {
    return letter >= ' ' && letter <= '~';
}

}  // namespace

void ArchiveWriter::add_section(const std::string& name, Span<const uint8_t> bytes, size_t element_bytes) {
    if (name.empty() || name.size() >= archive_name_bytes || !std::all_of(name.begin(), name.end(), is_plain))
        throw Error(ErrorKind::input, "section '" + name + "' has no name that an archive can hold");
    sections_.push_back({name, bytes, element_bytes});
}

void ArchiveWriter::write(const std::string& path, unsigned threads, Progress& progress) const {
    if (sections_.size() > most_sections)
        throw Error(ErrorKind::file, "cannot write '" + path + "': it would have more than " +
                                         std::to_string(most_sections) + " sections; draw fewer layers");
    std::vector<ArchiveSection> table(sections_.size());
    size_t end = sizeof(ArchiveHeader) + table.size() * sizeof(ArchiveSection);
    for (size_t i = 0; i < table.size(); ++i) {
        const Section& section = sections_[i];
        const size_t offset = aligned(end);
        end = offset + section.bytes.size();
        std::copy(section.name.begin(), section.name.end(), table[i].name.begin());
        table[i].offset = offset;
        table[i].bytes = section.bytes.size();
        table[i].element_bytes = section.element_bytes;
        table[i].digest = digest_of(section.bytes, threads);
    }
    ArchiveHeader header{magic, native_byte_order, archive_format, end, table.size(), {}};
    header.digest = digest_of_head(header, table);

    ReplacementFile file(path);
    file.append(bytes_of(Span<const ArchiveHeader>(&header, 1)));
    file.append(bytes_of(Span<const ArchiveSection>(table)));
    size_t written = sizeof(header) + table.size() * sizeof(ArchiveSection);
    const std::array<uint8_t, archive_alignment> zeros{};
    for (size_t i = 0; i < table.size(); ++i) {
        file.append(Span<const uint8_t>(zeros).subspan(0, table[i].offset - written));
        written = table[i].offset;
        for (size_t at = 0; at < table[i].bytes; at += write_bytes) {
            const size_t count = std::min<size_t>(write_bytes, table[i].bytes - at);
            file.append(sections_[i].bytes.subspan(at, count));
            written += count;
            progress.report(static_cast<double>(written) / static_cast<double>(end));
        }
    }
    file.finish();
    progress.report(1.0);
}

void ArchiveWriter::require_writable(const std::string& path) {
    const ReplacementFile probe(path);
}

ArchiveReader::ArchiveReader(const std::string& path) : path_(path), file_(map_file(path)) {
    check_header();
    check_table();
}

bool ArchiveReader::is_archive(const std::string& path) {
    const SharedArray<uint8_t> file = map_file(path);
    return file.size() >= magic.size() && std::memcmp(file.data(), magic.data(), magic.size()) == 0;
}

void ArchiveReader::check_header() {
    const auto require = [&](bool holds, const std::string& what) {
        if (!holds)
            throw Error(ErrorKind::file, "'" + path_ + "' " + what);
    };
    const std::string again = "; prepare the scene again and save it";
    require(file_.size() >= magic.size() && std::memcmp(file_.data(), magic.data(), magic.size()) == 0,
            "is not a prepared scene; name a file that was written by save");
    require(file_.size() >= sizeof(ArchiveHeader), "is cut short" + again);
    ArchiveHeader header{};
    std::memcpy(&header, file_.data(), sizeof(header));
    require(header.byte_order == native_byte_order, "was saved on a machine of another byte order" + again);
    require(header.format == archive_format, "was saved in format " + std::to_string(header.format) +
                                                 ", and this version of decalgl reads format " +
                                                 std::to_string(archive_format) + again);
    require(header.file_bytes <= file_.size(), "is cut short: it has " + std::to_string(file_.size()) +
                                                   " of " + std::to_string(header.file_bytes) +
                                                   " bytes; copy it again, or" + again.substr(1));
    const size_t room = (file_.size() - sizeof(header)) / sizeof(ArchiveSection);
    if (header.file_bytes != file_.size() || header.section_count > std::min<uint64_t>(room, most_sections))
        refuse("its header does not fit its size");
    const auto* table = reinterpret_cast<const ArchiveSection*>(file_.data() + sizeof(header));
    sections_ = {table, header.section_count};
    if (digest_of_head(header, sections_) != header.digest)
        refuse("its table of contents has changed since it was saved");
}

// A digest can be forged, so the table is checked whatever its digest says.
void ArchiveReader::check_table() {
    uint64_t end = sizeof(ArchiveHeader) + sections_.size_bytes();
    for (const ArchiveSection& section : sections_) {
        const std::string_view name = name_of(section);
        if (name.empty() || name.size() == archive_name_bytes ||
            !std::all_of(name.begin(), name.end(), is_plain) || !by_name_.emplace(name, &section).second)
            refuse("a section has no name of its own");
        if (section.offset % archive_alignment != 0 || section.offset < end ||
            section.offset > file_.size() || section.bytes > file_.size() - section.offset)
            refuse("section '" + std::string(name) + "' does not lie where a section can");
        if (section.element_bytes == 0 || section.bytes % section.element_bytes != 0)
            refuse("section '" + std::string(name) + "' does not hold whole elements");
        end = section.offset + section.bytes;
    }
}

void ArchiveReader::verify(unsigned threads) const {
    for (const ArchiveSection& section : sections_) {
        if (digest_of(file_.span().subspan(section.offset, section.bytes), threads) != section.digest)
            refuse("section '" + std::string(name_of(section)) + "' has changed since it was saved");
    }
}

const ArchiveSection& ArchiveReader::find(const std::string& name, size_t element_bytes) const {
    const auto found = by_name_.find(name);
    if (found == by_name_.end())
        refuse("section '" + name + "' is missing");
    if (found->second->element_bytes != element_bytes)
        refuse("section '" + name + "' has elements of another size");
    return *found->second;
}

void ArchiveReader::refuse(const std::string& what) const {
    throw Error(ErrorKind::file,
                "'" + path_ + "' is damaged: " + what + "; prepare the scene again and save it");
}

}  // namespace decalgl

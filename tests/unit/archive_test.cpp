// Archives: what is written is read, and whatever else a file holds is an error that says so.
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <limits>
#include <numeric>

#include "core/archive.h"
#include "core/mapped_file.h"
#include "decalgl/core/error.h"
#include "error_kind.h"
#include "forged_archive.h"

using namespace decalgl;
using namespace decalgl::test;

namespace {

struct Pair {
    uint32_t first;
    float second;
};

void write_sample(const std::string& path) {
    std::vector<uint32_t> numbers(1000);
    std::iota(numbers.begin(), numbers.end(), 7U);
    const std::vector<Pair> pairs{{1, 0.5F}, {2, -0.5F}};
    ArchiveWriter archive;
    archive.add("numbers", Span<const uint32_t>(numbers));
    archive.add("nothing", Span<const double>());
    archive.add_copy("pairs", Span<const Pair>(pairs));
    archive.add_value("one", int64_t{-5});
    archive.add_text("text", "Koʻolau");
    Progress progress;
    archive.write(path, 1, progress);
}

void check_sample(const std::string& path) {
    const ArchiveReader archive(path);
    archive.verify(1);
    const SharedArray<uint32_t> numbers = archive.array<uint32_t>("numbers");
    REQUIRE(numbers.size() == 1000);
    REQUIRE((numbers[0] == 7 && numbers[999] == 1006));
    REQUIRE(archive.array<double>("nothing").empty());
    REQUIRE(archive.array<Pair>("pairs")[1].second == -0.5F);
    REQUIRE(archive.value<int64_t>("one") == -5);
    REQUIRE(archive.text("text") == "Koʻolau");
}

std::string message_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        return error.kind() == ErrorKind::file ? error.what() : "no error of a file";
    }
    return "no error";
}

std::string opening(const std::string& path, const Bytes& bytes) {
    write_file(path, bytes);
    return message_of([&] { ArchiveReader(path).verify(1); });
}

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("a digest depends on every byte and not on the threads") {
    Bytes bytes(9'000'001);
    std::mt19937 random(1);
    std::generate(bytes.begin(), bytes.end(), [&] { return static_cast<uint8_t>(random()); });
    const Digest digest = digest_of(Span<const uint8_t>(bytes), 1);
    CHECK(digest_of(Span<const uint8_t>(bytes), 5) == digest);
    for (const size_t at : {size_t{0}, size_t{4'194'303}, size_t{4'194'304}, bytes.size() - 1}) {
        bytes[at] ^= 1;
        CHECK(digest_of(Span<const uint8_t>(bytes), 2) != digest);
        bytes[at] ^= 1;
    }
    DigestBuilder one(1), two(1);
    one.add(Span<const uint8_t>(bytes.data(), 3));
    one.add(Span<const uint8_t>(bytes.data() + 3, 1));
    two.add(Span<const uint8_t>(bytes.data(), 2));
    two.add(Span<const uint8_t>(bytes.data() + 2, 2));
    CHECK(one.finish() != two.finish());
}

TEST_CASE("an archive gives back what was written, for as long as any array is held") {
    const ScratchFolder folder;
    const std::string path = folder.file("sample");
    write_sample(path);
    check_sample(path);
    SharedArray<uint32_t> numbers;
    {
        const ArchiveReader archive(path);
        numbers = archive.array<uint32_t>("numbers");
        CHECK(reinterpret_cast<uintptr_t>(numbers.data()) % archive_alignment == 0);
        CHECK(archive.file_bytes() == read_file(path).size());
    }
    std::filesystem::remove(path);
    CHECK(std::accumulate(numbers.begin(), numbers.end(), 0U) == 506'500U);
}

TEST_CASE("sections are asked for as they were written") {
    const ScratchFolder folder;
    write_sample(folder.file("sample"));
    const ArchiveReader archive(folder.file("sample"));
    CHECK(has(message_of([&] { archive.array<uint32_t>("number"); }), "'number' is missing"));
    CHECK(has(message_of([&] { archive.array<uint64_t>("numbers"); }), "elements of another size"));
    CHECK(has(message_of([&] { archive.value<uint32_t>("numbers"); }), "one value"));
    CHECK(has(message_of([&] { archive.value<double>("nothing"); }), "one value"));
    ArchiveWriter writer;
    for (const std::string& name : {std::string(), std::string(48, 'a'), std::string("a\n")})
        CHECK(kind_of([&] { writer.add_value(name, 1); }) == ErrorKind::input);
}

TEST_CASE("a file that is cut short anywhere is refused") {
    const ScratchFolder folder;
    write_sample(folder.file("sample"));
    const Bytes whole = read_file(folder.file("sample"));
    for (size_t count = 0; count < whole.size(); count += count < 600 ? 1 : 37) {
        const std::string said =
            opening(folder.file("cut"), Bytes(whole.begin(), whole.begin() + static_cast<long>(count)));
        INFO(count << ": " << said);
        REQUIRE(has(said, count < 8 ? "is not a prepared scene" : "is cut short"));
    }
    Bytes longer = whole;
    longer.push_back(0);
    CHECK(has(opening(folder.file("cut"), longer), "does not fit its size"));
}

TEST_CASE("a byte that has changed is found, or lies between the sections") {
    const ScratchFolder folder;
    write_sample(folder.file("sample"));
    const Bytes whole = read_file(folder.file("sample"));
    const OpenArchive archive(whole);
    size_t harmless = 0;
    for (size_t at = 0; at < whole.size(); ++at) {
        Bytes changed = whole;
        changed[at] ^= 0x10;
        if (opening(folder.file("changed"), changed) == "no error") {
            check_sample(folder.file("changed"));
            ++harmless;
        }
    }
    size_t held = archive.head_bytes();
    for (const ArchiveSection& section : archive.table)
        held += section.bytes;
    CHECK(harmless == whole.size() - held);
}

TEST_CASE("messages say what is wrong") {
    const ScratchFolder folder;
    write_sample(folder.file("sample"));
    const Bytes whole = read_file(folder.file("sample"));
    const auto opening_with = [&](auto change) {
        OpenArchive archive(whole);
        change(archive);
        return opening(folder.file("changed"), archive.bytes());
    };
    CHECK(opening_with([](OpenArchive&) {}) == "no error");
    CHECK(has(opening_with([](OpenArchive& a) { a.header.magic[0] = 'd'; }), "not a prepared scene"));
    CHECK(has(opening_with([](OpenArchive& a) { ++a.header.format; }), "reads format"));
    CHECK(has(opening_with([](OpenArchive& a) { a.header.byte_order = 0x04030201; }), "byte order"));
    CHECK(has(opening_with([](OpenArchive& a) { a.rest[200] ^= 1; }), "'numbers' has changed"));
    CHECK(has(message_of([&] { ArchiveReader(folder.file("none")); }), "No such file"));
    CHECK(has(message_of([&] { ArchiveReader(folder.file("")); }), "Is a directory"));
    CHECK(has(message_of([&] { ArchiveReader(std::string("a\0b", 3)); }), "zero byte"));
    ::mkfifo(folder.file("pipe").c_str(), 0600);
    CHECK(has(message_of([&] { ArchiveReader(folder.file("pipe")); }), "not a regular file"));
    CHECK(has(message_of([] { ArchiveReader("/dev/zero"); }), "not a regular file"));
}

TEST_CASE("a table that lies is refused though its digest fits") {
    constexpr uint64_t huge = std::numeric_limits<uint64_t>::max();
    const ScratchFolder folder;
    write_sample(folder.file("sample"));
    const Bytes whole = read_file(folder.file("sample"));
    const auto refused = [&](auto change) {
        OpenArchive archive(whole);
        change(archive.table);
        return has(opening(folder.file("changed"), archive.bytes()), "is damaged");
    };
    using Table = std::vector<ArchiveSection>;
    CHECK(refused([](Table& t) { t[0].offset += 1; }));
    CHECK(refused([](Table& t) { t[0].offset = 0; }));
    CHECK(refused([](Table& t) { t[1].offset = t[0].offset; }));
    CHECK(refused([](Table& t) { std::swap(t[2].offset, t[3].offset); }));
    CHECK(refused([=](Table& t) { t[0].offset = huge - 63; }));
    CHECK(refused([](Table& t) { t[0].bytes += 64; }));
    CHECK(refused([=](Table& t) { t[4].bytes = huge; }));
    CHECK(refused([=](Table& t) { t[4].bytes = huge - t[4].offset + 1; }));
    CHECK(refused([](Table& t) { t[0].element_bytes = 0; }));
    CHECK(refused([](Table& t) { t[0].element_bytes = 3; }));
    CHECK(refused([](Table& t) { t[1].name = t[0].name; }));
    CHECK(refused([](Table& t) { t[0].name.fill('a'); }));
    CHECK(refused([](Table& t) { t[0].name.fill(0); }));
    CHECK(refused([](Table& t) { t[0].name[2] = '\n'; }));
    for (const uint64_t count : {uint64_t{6}, uint64_t{70'000}, huge / 88 + 1, huge}) {
        OpenArchive archive(whole);
        archive.header.section_count = count;
        CHECK(has(opening(folder.file("changed"), archive.bytes()), "is damaged"));
    }
}

TEST_CASE("random heads whose digest fits end in an error or in arrays that can be read") {
    const ScratchFolder folder;
    write_sample(folder.file("sample"));
    const Bytes whole = read_file(folder.file("sample"));
    std::mt19937 random(3);
    size_t opened = 0;
    for (int trial = 0; trial < 3000; ++trial) {
        OpenArchive archive(whole);
        auto* fields = reinterpret_cast<uint8_t*>(archive.table.data());
        const size_t bytes = archive.table.size() * sizeof(ArchiveSection);
        for (size_t changes = 1 + random() % 3; changes > 0; --changes)
            fields[random() % bytes] =
                static_cast<uint8_t>(random() % 2 == 0 ? random() : random() % 2 * 255);
        write_file(folder.file("changed"), archive.bytes());
        try {
            const ArchiveReader reader(folder.file("changed"));
            size_t sum = 0;
            for (const ArchiveSection& section : reader.sections()) {
                if (section.element_bytes == 4)
                    for (const uint32_t value : reader.array<uint32_t>(section.name.data()))
                        sum += value;
            }
            opened += sum > 0;
            reader.verify(1);
        } catch (const Error& error) {
            REQUIRE(error.kind() == ErrorKind::file);
        }
    }
    CHECK(opened > 0);
}

TEST_CASE("writing that fails leaves what was there, and nothing else") {
    const ScratchFolder folder;
    const std::string path = folder.file("sample");
    write_sample(path);
    const Bytes before = read_file(path);
    const std::vector<uint8_t> large(40'000'000);
    ArchiveWriter archive;
    archive.add("large", Span<const uint8_t>(large));
    Progress cancelled([](std::string_view, double share) { return share < 0.5; }, "saving");
    CHECK(kind_of([&] { archive.write(path, 1, cancelled); }) == ErrorKind::cancelled);
    CHECK(folder.count() == 1);
    CHECK(read_file(path) == before);

    const ArchiveReader old(path);
    Progress progress;
    archive.write(path, 1, progress);
    CHECK(old.array<uint32_t>("numbers")[999] == 1006);
    CHECK(ArchiveReader(path).array<uint8_t>("large").size() == large.size());
    CHECK(folder.count() == 1);
}

TEST_CASE("only regular files are replaced, and links are followed") {
    const ScratchFolder folder;
    const auto writing = [](const std::string& path) { return message_of([&] { write_sample(path); }); };
    CHECK(has(writing(folder.file("")), "Is a directory"));
    CHECK(has(writing(folder.file("none/sample")), "No such file"));
    CHECK(has(writing(std::string("a\0b", 3)), "zero byte"));
    CHECK(has(writing(""), "empty"));
    CHECK(has(writing(folder.file(std::string(300, 'a'))), "File name too long"));
    ::mkfifo(folder.file("pipe").c_str(), 0600);
    CHECK(has(writing(folder.file("pipe")), "File exists"));
    std::filesystem::create_symlink("target", folder.file("link"));
    write_file(folder.file("target"), {1, 2, 3});
    write_sample(folder.file("link"));
    CHECK(std::filesystem::is_symlink(folder.file("link")));
    check_sample(folder.file("target"));
    CHECK(folder.count() == 3);
}

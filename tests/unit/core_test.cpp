// The parts that everything stands on: spans, parallel loops, progress, memory accounts, the radix sort.

#include "error_kind.h"

#include "decalgl/core/error.h"
#include "decalgl/core/memory.h"
#include "decalgl/core/parallel.h"
#include "decalgl/core/progress.h"
#include "decalgl/core/radix_sort.h"
#include "decalgl/core/span.h"
#include "decalgl/core/timing.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <mutex>
#include <numeric>
#include <random>
#include <set>
#include <thread>
#include <vector>

using namespace decalgl;
using test::kind_of;

namespace {

template <typename Key>
void check_sort(std::size_t size, Key mask, unsigned threads, unsigned key_bits) {
    std::mt19937_64 random(size);
    std::vector<Key> keys(size);
    std::generate(keys.begin(), keys.end(), [&] { return static_cast<Key>(random()) & mask; });
    std::vector<std::uint32_t> payload(size);
    std::iota(payload.begin(), payload.end(), 0U);

    std::vector<std::uint32_t> order = payload;
    std::stable_sort(order.begin(), order.end(),
                     [&](auto left, auto right) { return keys[left] < keys[right]; });
    std::vector<Key> expected(size);
    std::transform(order.begin(), order.end(), expected.begin(), [&](auto index) { return keys[index]; });

    radix_sort(Span<Key>(keys), Span<std::uint32_t>(payload), threads, key_bits);
    REQUIRE(keys == expected);
    REQUIRE(payload == order);
}

}  // namespace

TEST_CASE("a span views what others own") {
    std::vector<int> values{1, 2, 3, 4};
    const Span<int> span(values);
    span[1] = 7;
    CHECK(values[1] == 7);
    CHECK(span.size_bytes() == 16);
    const Span<const int> tail = Span<const int>(span).subspan(2);
    CHECK(std::vector<int>(tail.begin(), tail.end()) == std::vector<int>{3, 4});
    CHECK(Span<int>().empty());
}

TEST_CASE("parallel_for covers every item once, in blocks that do not depend on the threads") {
    for (const unsigned threads : {1U, 2U, 5U}) {
        for (const std::size_t count :
             {std::size_t{0}, std::size_t{1}, std::size_t{1000}, std::size_t{1001}}) {
            std::vector<std::atomic<int>> visits(count);
            std::mutex mutex;
            std::set<std::pair<std::size_t, std::size_t>> blocks;
            parallel_for(count, 100, threads, [&](std::size_t begin, std::size_t end) {
                for (std::size_t index = begin; index < end; ++index) {
                    ++visits[index];
                }
                const std::lock_guard<std::mutex> lock(mutex);
                blocks.emplace(begin, end);
            });
            CHECK(std::all_of(visits.begin(), visits.end(), [](const auto& visit) { return visit == 1; }));
            CHECK(blocks.size() == block_count(count, 100));
            CHECK(std::all_of(blocks.begin(), blocks.end(),
                              [](const auto& block) { return block.first % 100 == 0; }));
        }
    }
}

TEST_CASE("parallel_for passes on the first exception after all threads have ended") {
    std::atomic<int> running{0};
    CHECK(kind_of([&] {
              parallel_for(1000, 1, 4, [&](std::size_t begin, std::size_t) {
                  ++running;
                  if (begin == 17) {
                      --running;
                      throw Error(ErrorKind::input, "seventeen");
                  }
                  --running;
              });
          }) == ErrorKind::input);
    CHECK(running == 0);
}

TEST_CASE("parallel_for reports on the calling thread, which may stop it") {
    const auto caller = std::this_thread::get_id();
    std::atomic<int> done{0};
    double last = -1.0;
    parallel_for(
        64, 1, 3, [&](std::size_t, std::size_t) { ++done; },
        [&](double share) {
            CHECK(std::this_thread::get_id() == caller);
            CHECK(share >= last);
            last = share;
        });
    CHECK(done == 64);
    CHECK(last == 1.0);

    Progress progress([](std::string_view, double) { return false; }, "sorting");
    CHECK(kind_of([&] {
              parallel_for(
                  64, 1, 3, [](std::size_t, std::size_t) {}, [&](double share) { progress.report(share); });
          }) == ErrorKind::cancelled);
}

TEST_CASE("parallel_for reports the end even where the helpers do all the work") {
    std::atomic<int> done{0};
    std::vector<double> shares;
    parallel_for(
        8, 1, 2, [&](std::size_t, std::size_t) { ++done; },
        [&](double share) {
            shares.push_back(share);
            while (done < 8) {  // holds the caller until the helper has taken every block
                std::this_thread::yield();
            }
        });
    CHECK(shares.back() == 1.0);
    CHECK(std::count(shares.begin(), shares.end(), 1.0) == 1);
}

TEST_CASE("DECALGL_THREADS overrides the number of cores") {
    ::setenv("DECALGL_THREADS", "3", 1);
    CHECK(hardware_threads() == 3);
    ::setenv("DECALGL_THREADS", "none", 1);
    CHECK(hardware_threads() >= 1);
    ::unsetenv("DECALGL_THREADS");
}

TEST_CASE("progress stays within 0 to 1, never goes back, and cancels with an error") {
    std::vector<double> fractions;
    bool go_on = true;
    Progress progress(
        [&](std::string_view stage, double fraction) {
            CHECK(stage == "indexing");
            fractions.push_back(fraction);
            return go_on;
        },
        "indexing");
    progress.report(-1.0);
    progress.report(0.5);
    progress.report(0.25);
    progress.report(7.0);
    CHECK(fractions == std::vector<double>{0.0, 0.5, 0.5, 1.0});
    go_on = false;
    CHECK(kind_of([&] { progress.report(1.0); }) == ErrorKind::cancelled);
    Progress().report(0.5);
}

TEST_CASE("a memory account refuses what its budget has no room for") {
    MemoryAccount account(1000);
    account.add("cells", 600);
    try {
        account.add("references", 500);
        FAIL("the budget was passed");
    } catch (const Error& error) {
        const std::string message = error.what();
        CHECK(error.kind() == ErrorKind::memory);
        CHECK_THAT(message, Catch::Contains("references needs 500 bytes") && Catch::Contains("600 bytes") &&
                                Catch::Contains("memory_limit"));
    }
    CHECK(kind_of([&] { account.add("all", UINT64_MAX); }) == ErrorKind::memory);
    CHECK(account.total() == 600);
    CHECK(account.bytes("references") == 0);
    account.remove("cells", 10000);
    CHECK(account.total() == 0);
    CHECK(account.peak() == 600);
    CHECK(account.entries().empty());

    MemoryAccount unlimited;
    unlimited.add("one", 1);
    CHECK(kind_of([&] { unlimited.add("all", UINT64_MAX); }) == ErrorKind::memory);
}

TEST_CASE("a memory charge lasts as long as its object") {
    MemoryAccount account(1000);
    {
        MemoryCharge first(account, "texture", 400);
        MemoryCharge second = std::move(first);
        CHECK(account.total() == 400);
        second.resize(700);
        CHECK(account.bytes("texture") == 700);
        CHECK(kind_of([&] { second.resize(1001); }) == ErrorKind::memory);
        CHECK(account.bytes("texture") == 700);
        second = MemoryCharge(account, "buffer", 100);
        CHECK(account.total() == 100);
    }
    CHECK(account.total() == 0);
    MemoryCharge orphan;
    { orphan = MemoryCharge(MemoryAccount(10), "gone", 10); }
    CHECK(orphan.bytes() == 10);
}

TEST_CASE("bytes are written for people") {
    CHECK(format_bytes(0) == "0 bytes");
    CHECK(format_bytes(1023) == "1023 bytes");
    CHECK(format_bytes(1536) == "1.5 KiB");
    CHECK(format_bytes(std::uint64_t{3} << 30) == "3.0 GiB");
}

TEST_CASE("a timing log sums passes by name") {
    TimingLog log;
    log.add("terrain", 2.0);
    log.add("compose", 1.0);
    log.add("terrain", 3.0);
    CHECK(log.total() == 6.0);
    CHECK(log.total("terrain") == 5.0);
    CHECK(log.total("overlay") == 0.0);
}

TEST_CASE("ascending() is a stable sort of numbers of any sign, with NaN as -infinity") {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<double> edges{0.0,  1.5, -0.0,      -2.0,    infinity, nan, 5e-324, -1e300,
                                    -nan, 0.0, -infinity, -5e-324, 1e300,    nan, -2.0};
    CHECK(ascending(edges) == std::vector<std::int64_t>{5, 8, 10, 13, 7, 3, 14, 11, 0, 2, 9, 6, 1, 12, 4});
    CHECK(ascending({}).empty());

    std::mt19937_64 random(1);
    std::normal_distribution<double> normal(0.0, 100.0);
    std::vector<double> keys(50000);
    std::generate(keys.begin(), keys.end(), [&] { return std::round(normal(random)) / 8.0; });
    std::vector<std::int64_t> order(keys.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::int64_t left, std::int64_t right) { return keys[left] < keys[right]; });
    for (const unsigned threads : {1U, 2U, 7U}) {
        CHECK(ascending(keys, threads) == order);
    }
}

TEST_CASE("the radix sort is a stable sort, whatever the threads") {
    for (const unsigned threads : {1U, 2U, 7U}) {
        for (const std::size_t size : {0UL, 1UL, 2UL, 15UL, 17UL, 1000UL, 16384UL, 100003UL}) {
            check_sort<std::uint32_t>(size, UINT32_MAX, threads, 0);
            check_sort<std::uint64_t>(size, UINT64_MAX, threads, 0);
        }
        check_sort<std::uint32_t>(50000, 0xfff, threads, 12);
        check_sort<std::uint32_t>(50000, 0xff00ff, threads, 0);
        check_sort<std::uint64_t>(50000, 0xffffffffffULL, threads, 40);
    }
    std::vector<std::uint32_t> keys(3);
    std::vector<std::uint32_t> payload(2);
    CHECK(kind_of([&] { radix_sort(Span<std::uint32_t>(keys), Span<std::uint32_t>(payload)); }) ==
          ErrorKind::input);
}

// Where the samples of a pixel lie.
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <utility>

#include "frame/sample_pattern.h"

using namespace decalgl;

TEST_CASE("patterns have a power of two of samples") {
    std::set<int> counts;
    for (int count = -1; count <= 100; ++count)
        if (has_sample_pattern(count))
            counts.insert(count);
    CHECK(counts == std::set<int>{1, 2, 4, 8, 16, 32});
}

TEST_CASE("a pixel's samples lie evenly around its centre") {
    const int count = GENERATE(1, 2, 4, 8, 16, 32);
    const std::vector<glm::vec2> offsets = sample_pattern(count);
    REQUIRE(offsets.size() == static_cast<size_t>(count));
    glm::vec2 sum(0.0F);
    for (const glm::vec2 offset : offsets)
        sum += offset;
    CHECK(sum.x == 0.0F);
    CHECK(sum.y == 0.0F);
    // One in each of any columns x rows equal boxes.
    for (int columns = 1; columns <= count; columns *= 2) {
        const int rows = count / columns;
        std::set<std::pair<int, int>> boxes;
        for (const glm::vec2 offset : offsets) {
            REQUIRE(std::abs(offset.x) < 0.5F);
            REQUIRE(std::abs(offset.y) < 0.5F);
            boxes.emplace(static_cast<int>((offset.x + 0.5F) * static_cast<float>(columns)),
                          static_cast<int>((offset.y + 0.5F) * static_cast<float>(rows)));
        }
        CHECK(boxes.size() == offsets.size());
    }
}

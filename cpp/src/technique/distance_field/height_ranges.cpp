#include "technique/distance_field/height_ranges.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "decalgl/core/parallel.h"

namespace decalgl::network {
namespace {

constexpr HeightRange no_ground{std::numeric_limits<float>::infinity(),
                                -std::numeric_limits<float>::infinity()};
constexpr int32_t most_samples = 4;  // along a side of the rectangle, before a coarser level is taken
constexpr double steps = 65535.0;

HeightRange joined(HeightRange a, HeightRange b) {
    return {std::min(a.lowest, b.lowest), std::max(a.highest, b.highest)};
}

}  // namespace

HeightRanges::HeightRanges(const Heightfield& terrain, unsigned threads) : terrain_(terrain) {
    int32_t rows = terrain.rows(), columns = terrain.columns();
    while (rows > 1 || columns > 1) {
        Level next{(rows + 1) / 2, (columns + 1) / 2, {}};
        next.ranges.resize(static_cast<size_t>(next.rows) * static_cast<size_t>(next.columns), no_ground);
        const size_t below = levels_.size();
        const auto row_count = static_cast<size_t>(next.rows);
        parallel_for(row_count, 64, threads, [&](size_t begin, size_t end) {
            for (size_t row = begin; row < end; ++row)
                for (int32_t column = 0; column < next.columns; ++column) {
                    HeightRange range = no_ground;
                    for (int32_t i = 0; i < 4; ++i) {
                        const int32_t r = 2 * static_cast<int32_t>(row) + i / 2, c = 2 * column + i % 2;
                        if (r < rows && c < columns)
                            range = joined(range, at(below, r, c));
                    }
                    next.ranges[row * static_cast<size_t>(next.columns) + static_cast<size_t>(column)] =
                        range;
                }
        });
        rows = next.rows;
        columns = next.columns;
        levels_.push_back(std::move(next));
    }
}

// Level 0 are the samples themselves.
HeightRange HeightRanges::at(size_t level, int32_t row, int32_t column) const {
    if (level == 0) {
        const float height = terrain_.height(row, column);
        return std::isnan(height) ? no_ground : HeightRange{height, height};
    }
    const Level& own = levels_[level - 1];
    return own
        .ranges[static_cast<size_t>(row) * static_cast<size_t>(own.columns) + static_cast<size_t>(column)];
}

HeightRange HeightRanges::over(const Bounds& rectangle) const {
    const auto index = [](double place, int32_t count) {
        return static_cast<int32_t>(std::clamp(place, 0.0, static_cast<double>(count - 1)));
    };
    const Heightfield& t = terrain_;
    int32_t left = index(std::floor((rectangle.min_x - t.x0()) / t.dx()), t.columns());
    int32_t right = index(std::ceil((rectangle.max_x - t.x0()) / t.dx()), t.columns());
    int32_t top = index(std::floor((t.y0() - rectangle.max_y) / t.dy()), t.rows());
    int32_t bottom = index(std::ceil((t.y0() - rectangle.min_y) / t.dy()), t.rows());
    size_t level = 0;
    while (std::max(right - left, bottom - top) > most_samples && level < levels_.size()) {
        left /= 2, right /= 2, top /= 2, bottom /= 2;
        ++level;
    }
    HeightRange range = no_ground;
    for (int32_t row = top; row <= bottom; ++row)
        for (int32_t column = left; column <= right; ++column)
            range = joined(range, at(level, row, column));
    return range;
}

double HeightRanges::step() const {
    return std::max((double{highest()} - lowest()) / steps, 1e-6);
}

uint32_t HeightRanges::packed(const HeightRange& range) const {
    if (range.highest < range.lowest)
        return 0xFFFFU;  // above itself: nothing to be seen
    const auto count = [&](double height) { return (height - lowest()) / step(); };
    const auto low = static_cast<uint32_t>(std::clamp(std::floor(count(range.lowest)), 0.0, steps));
    const auto high = static_cast<uint32_t>(std::clamp(std::ceil(count(range.highest)), 0.0, steps));
    return low | high << 16U;
}

}  // namespace decalgl::network

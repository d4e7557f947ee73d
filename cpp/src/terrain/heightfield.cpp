#include "decalgl/terrain/heightfield.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "decalgl/core/error.h"
#include "decalgl/core/parallel.h"

namespace decalgl {
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr size_t block_samples = size_t{1} << 18;
constexpr size_t lanes = 16;

struct Range {
    float lowest = infinite;
    float highest = -infinite;
};

// In lanes, which the compiler lays side by side into registers. A missing sample compares as false and
// changes nothing.
Range range_of(Span<const float> heights) {
    std::array<float, lanes> lowest, highest;
    lowest.fill(infinite);
    highest.fill(-infinite);
    const auto add = [&](size_t first, size_t count) {
        for (size_t lane = 0; lane < count; ++lane) {
            const float height = heights[first + lane];
            lowest[lane] = height < lowest[lane] ? height : lowest[lane];
            highest[lane] = height > highest[lane] ? height : highest[lane];
        }
    };
    const size_t whole = heights.size() / lanes * lanes;
    for (size_t first = 0; first < whole; first += lanes)
        add(first, lanes);
    add(whole, heights.size() - whole);
    return {*std::min_element(lowest.begin(), lowest.end()),
            *std::max_element(highest.begin(), highest.end())};
}

}  // namespace

Heightfield::Heightfield(SharedArray<float> heights, int32_t rows, int32_t columns, double x0, double y0,
                         double dx, double dy)
    : heights_(std::move(heights)), rows_(rows), columns_(columns), x0_(x0), y0_(y0), dx_(dx), dy_(dy) {
    if (rows < 1 || columns < 1 ||
        heights_.size() != static_cast<size_t>(rows) * static_cast<size_t>(columns))
        throw Error(ErrorKind::input, "terrain: " + std::to_string(heights_.size()) +
                                          " heights do not make " + std::to_string(rows) + " rows of " +
                                          std::to_string(columns) + " columns");
    if (!std::isfinite(x0) || !std::isfinite(y0) || !(dx > 0.0) || !(dy > 0.0) || !std::isfinite(dx * dy))
        throw Error(ErrorKind::input,
                    "terrain: the position must be finite and the sample distances positive");
    measure();
}

// Finds the lowest and the highest sample.
void Heightfield::measure() {
    std::vector<Range> ranges(block_count(heights_.size(), block_samples));
    parallel_for(heights_.size(), block_samples, 0, [&](size_t begin, size_t end) {
        ranges[begin / block_samples] = range_of(heights_.span().subspan(begin, end - begin));
    });
    for (const Range& range : ranges) {
        lowest_ = std::min(lowest_, range.lowest);
        highest_ = std::max(highest_, range.highest);
    }
    if (highest_ < infinite && lowest_ > -infinite)
        return;
    const auto* odd =
        std::find_if(heights_.begin(), heights_.end(), [](float height) { return std::isinf(height); });
    throw Error(ErrorKind::input, "terrain: the height of sample " + std::to_string(odd - heights_.begin()) +
                                      " is infinite; mark missing samples with NaN");
}

Heightfield Heightfield::flat(const Bounds& bounds, float height) {
    if (!(bounds.max_x > bounds.min_x) || !(bounds.max_y > bounds.min_y))
        throw Error(ErrorKind::input,
                    "terrain: bounds must be (min x, min y, max x, max y) with min below max");
    return Heightfield({height, height, height, height}, 2, 2, bounds.min_x, bounds.max_y,
                       bounds.max_x - bounds.min_x, bounds.max_y - bounds.min_y);
}

Heightfield Heightfield::exaggerated(double factor) const {
    if (!std::isfinite(factor) || factor < 0.0)
        throw Error(ErrorKind::input, "exaggeration must be a finite factor, zero or more");
    std::vector<float> scaled(heights_.begin(), heights_.end());
    for (float& height : scaled)
        height = static_cast<float>(static_cast<double>(height) * factor);
    return Heightfield(std::move(scaled), rows_, columns_, x0_, y0_, dx_, dy_);
}

double Heightfield::height_at(double x, double y) const {
    if (std::isnan(x) || std::isnan(y))
        return std::numeric_limits<double>::quiet_NaN();
    const double column = std::clamp((x - x0_) / dx_, 0.0, columns_ - 1.0);
    const double row = std::clamp((y0_ - y) / dy_, 0.0, rows_ - 1.0);
    const auto left = std::min(static_cast<int32_t>(column), columns_ - 2);
    const auto top = std::min(static_cast<int32_t>(row), rows_ - 2);
    const double east = column - left, south = row - top;
    const auto sample = [&](int32_t down, int32_t right) -> double {
        return height(top + down, left + right);
    };
    const double north_west = sample(0, 0), south_east = sample(1, 1);
    if (south > east)
        return north_west + east * (south_east - sample(1, 0)) + south * (sample(1, 0) - north_west);
    return north_west + east * (sample(0, 1) - north_west) + south * (south_east - sample(0, 1));
}

Bounds Heightfield::bounds() const {
    return {x0_, y0_ - (rows_ - 1) * dy_, x0_ + (columns_ - 1) * dx_, y0_};
}

}  // namespace decalgl

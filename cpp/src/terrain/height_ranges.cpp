#include "terrain/height_ranges.h"

#include <cmath>

namespace decalgl {
namespace {

constexpr int32_t farthest = 4;  // from a rectangle's first sample or block to its last
constexpr double steps = 65535.0;

int32_t half(int32_t count) {
    return (count + 1) / 2;
}

}  // namespace

HeightRanges::HeightRanges(const Heightfield& terrain, unsigned threads, const MemoryAccount& memory,
                           const std::string& name)
    : terrain_(terrain),
      charge_(memory, name, Pyramid<HeightRange>::bytes(half(terrain.columns()), half(terrain.rows()))) {
    blocks_ = {half(terrain.columns()), half(terrain.rows()), HeightRange{}, threads,
               [&](int32_t row, int32_t column) {
                   return of_samples({2 * column, std::min(2 * column + 1, terrain_.columns() - 1), 2 * row,
                                      std::min(2 * row + 1, terrain_.rows() - 1)});
               }};
}

HeightRange HeightRanges::of_samples(const BlockBox& box) const {
    HeightRange range;
    for (int32_t row = box.top; row <= box.bottom; ++row)
        for (int32_t column = box.left; column <= box.right; ++column) {
            const float height = terrain_.height(row, column);
            if (!std::isnan(height))
                range.add({height, height});
        }
    return range;
}

HeightRange HeightRanges::over(const Bounds& rectangle) const {
    const Heightfield& t = terrain_;
    const Bounds all = t.bounds();
    if (rectangle.max_x < all.min_x || rectangle.min_x > all.max_x || rectangle.max_y < all.min_y ||
        rectangle.min_y > all.max_y)
        return {};
    const auto index = [](double place, int32_t count) {
        return static_cast<int32_t>(std::clamp(place, 0.0, static_cast<double>(count - 1)));
    };
    BlockBox box{index(std::floor((rectangle.min_x - t.x0()) / t.dx()), t.columns()),
                 index(std::ceil((rectangle.max_x - t.x0()) / t.dx()), t.columns()),
                 index(std::floor((t.y0() - rectangle.max_y) / t.dy()), t.rows()),
                 index(std::ceil((t.y0() - rectangle.min_y) / t.dy()), t.rows())};
    if (box.across() <= farthest)
        return of_samples(box);
    box.halve();
    return blocks_.over(box, farthest);
}

double HeightRanges::step() const {
    return std::max((double{highest()} - lowest()) / steps, 1e-6);
}

uint32_t HeightRanges::packed(const HeightRange& range) const {
    if (range.empty())
        return 0xFFFFU;  // above itself: nothing to be seen
    const auto count = [&](double height) { return (height - lowest()) / step(); };
    const auto low = static_cast<uint32_t>(std::clamp(std::floor(count(range.lowest)), 0.0, steps));
    const auto high = static_cast<uint32_t>(std::clamp(std::ceil(count(range.highest)), 0.0, steps));
    return low | high << 16U;
}

}  // namespace decalgl

#include "decalgl/core/position_grid.h"

#include <algorithm>
#include <cmath>

namespace decalgl {
namespace {

constexpr double largest_block = 32.0;
constexpr double smallest_span = 1.0 / 1024.0;

}  // namespace

PositionGrid PositionGrid::around(const Bounds& bounds) {
    const double extent = std::max({bounds.max_x - bounds.min_x, bounds.max_y - bounds.min_y, smallest_span});
    PositionGrid grid;
    grid.span = std::exp2(std::ceil(std::log2(extent)));
    grid.origin_x = std::floor(bounds.min_x / grid.span) * grid.span;
    grid.origin_y = std::floor(bounds.min_y / grid.span) * grid.span;
    grid.block_size = std::min(largest_block, grid.span);
    return grid;
}

}  // namespace decalgl

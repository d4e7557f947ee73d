// The lattice: integer coordinates for everything the BVH index holds, and for the pixels that ask it.
//
// Counted from a corner of the position grid's blocks, the terrain is at most 2^30 quanta wide, and vertices
// lie at most half of that beyond it, so differences fit 32 bits and products of two of them 64:
//
//     -2^29          0             terrain            2^30          2^30 + 2^29
//       |............[#################################]................|
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/lattice_points.h"
#include "decalgl/core/position_grid.h"

namespace decalgl::bvh {

using lattice::LatticeBox;
using lattice::LatticePoint;

constexpr int32_t lattice_extent = 1 << 30;
constexpr int32_t lattice_margin = (1 << 29) - 1;

struct Lattice {
    double left = 0.0;  // metres, of (0, 0)
    double bottom = 0.0;
    double quantum = 1.0;  // metres, a power of two
    int32_t first_block_x = 0;
    int32_t first_block_y = 0;
    LatticeBox terrain;  // nothing outside is ever seen

    // `reach`: half the width of the widest line, metres; the lattice is coarser where that passes its
    // margin.
    static Lattice over(const Bounds& bounds, const PositionGrid& positions, double reach) {
        const double extent =
            std::max(bounds.max_x - bounds.min_x, bounds.max_y - bounds.min_y) + positions.block_size;
        const auto power_above = [](double value) { return std::exp2(std::ceil(std::log2(value))); };
        Lattice lattice;
        lattice.quantum = power_above(std::max(extent / lattice_extent, reach / lattice_margin));
        lattice.first_block_x =
            static_cast<int32_t>(std::floor((bounds.min_x - positions.origin_x) / positions.block_size));
        lattice.first_block_y =
            static_cast<int32_t>(std::floor((bounds.min_y - positions.origin_y) / positions.block_size));
        lattice.left = positions.origin_x + lattice.first_block_x * positions.block_size;
        lattice.bottom = positions.origin_y + lattice.first_block_y * positions.block_size;
        const LatticePoint low = lattice.nearest(bounds.min_x, bounds.min_y);
        const LatticePoint high = lattice.nearest(bounds.max_x, bounds.max_y);
        lattice.terrain = {low.x, low.y, high.x, high.y};
        return lattice;
    }

    double x_of(double x) const { return (x - left) / quantum; }
    double y_of(double y) const { return (y - bottom) / quantum; }

    // As the shaders round; the position lies on the terrain.
    LatticePoint nearest(double x, double y) const {
        return {static_cast<int32_t>(std::lrint(x_of(x))), static_cast<int32_t>(std::lrint(y_of(y)))};
    }
};

}  // namespace decalgl::bvh

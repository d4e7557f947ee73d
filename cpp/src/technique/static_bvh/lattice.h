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

#include "decalgl/core/position_grid.h"

namespace decalgl::bvh {

struct LatticePoint {
    int32_t x;
    int32_t y;
};

inline bool operator==(LatticePoint a, LatticePoint b) {
    return a.x == b.x && a.y == b.y;
}

// Holds its border; empty where a minimum is above its maximum.
struct LatticeBox {
    int32_t min_x;
    int32_t min_y;
    int32_t max_x;
    int32_t max_y;

    bool empty() const { return min_x > max_x || min_y > max_y; }
    bool holds(LatticePoint p) const { return min_x <= p.x && p.x <= max_x && min_y <= p.y && p.y <= max_y; }
    bool holds(const LatticeBox& other) const {
        return min_x <= other.min_x && other.max_x <= max_x && min_y <= other.min_y && other.max_y <= max_y;
    }
    bool meets(const LatticeBox& other) const {
        return std::max(min_x, other.min_x) <= std::min(max_x, other.max_x) &&
               std::max(min_y, other.min_y) <= std::min(max_y, other.max_y);
    }
};

constexpr int32_t lattice_extent = 1 << 30;
constexpr int32_t lattice_margin = (1 << 29) - 1;
constexpr LatticeBox empty_box{INT32_MAX, INT32_MAX, INT32_MIN, INT32_MIN};

inline LatticeBox merged(const LatticeBox& a, const LatticeBox& b) {
    return {std::min(a.min_x, b.min_x), std::min(a.min_y, b.min_y), std::max(a.max_x, b.max_x),
            std::max(a.max_y, b.max_y)};
}

inline LatticeBox common(const LatticeBox& a, const LatticeBox& b) {
    return {std::max(a.min_x, b.min_x), std::max(a.min_y, b.min_y), std::min(a.max_x, b.max_x),
            std::min(a.max_y, b.max_y)};
}

struct Lattice {
    double left = 0.0;  // metres, of (0, 0)
    double bottom = 0.0;
    double quantum = 1.0;  // metres, a power of two
    int32_t first_block_x = 0;
    int32_t first_block_y = 0;
    LatticeBox terrain{};  // nothing outside is ever seen

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

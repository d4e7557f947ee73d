// The lattice of LOOPS: integer coordinates, in which everything about crossings is decided exactly.
//
// It covers the terrain and a margin of the terrain's size on every side, in 2^30 quanta at most. So
// differences of coordinates fit 31 bits, and a cross product of two of them 63. What lies beyond the margin
// is cut off, far out of sight.
//
//     0                                                     2^30
//     +----------------+=================+------------------+
//     |     margin     |     terrain     |      margin      |
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/lattice_points.h"
#include "decalgl/core/position_grid.h"

namespace decalgl::loops {

using lattice::doubled_area;
using lattice::LatticeBox;
using lattice::LatticePoint;

constexpr int lattice_bits = 30;
constexpr double lattice_extent = 1 << lattice_bits;

// Whether the closed triangle holds p; one without area is the segments between its corners.
inline bool triangle_holds(LatticePoint a, LatticePoint b, LatticePoint c, LatticePoint p) {
    if (p.x < std::min({a.x, b.x, c.x}) || p.x > std::max({a.x, b.x, c.x}) ||
        p.y < std::min({a.y, b.y, c.y}) || p.y > std::max({a.y, b.y, c.y}))
        return false;
    const int64_t ab = doubled_area(a, b, p), bc = doubled_area(b, c, p), ca = doubled_area(c, a, p);
    return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
}

inline LatticeBox box_of(LatticePoint a, LatticePoint b, LatticePoint c) {
    LatticeBox box;
    box.add(a);
    box.add(b);
    box.add(c);
    return box;
}

inline double distance_between(LatticePoint a, LatticePoint b) {
    return std::hypot(double(a.x) - b.x, double(a.y) - b.y);
}

// From p to the segment a-b, ends included.
inline double distance_to_segment(LatticePoint p, LatticePoint a, LatticePoint b) {
    const double dx = double(b.x) - a.x, dy = double(b.y) - a.y;
    const double px = double(p.x) - a.x, py = double(p.y) - a.y;
    const double length2 = dx * dx + dy * dy;
    const double along = px * dx + py * dy;
    if (along <= 0.0)
        return std::hypot(px, py);
    if (along >= length2)
        return distance_between(p, b);
    return std::abs(px * dy - py * dx) / std::sqrt(length2);
}

struct Lattice {
    double left = 0.0;  // metres, of (0, 0)
    double bottom = 0.0;
    double quantum = 1.0;  // metres, a power of two
    int32_t first_block_x = 0;
    int32_t first_block_y = 0;
    LatticeBox terrain;

    // `reach`: half the width of the widest line, metres.
    static Lattice over(const Bounds& bounds, const PositionGrid& positions, double reach) {
        const double extent = std::max(bounds.max_x - bounds.min_x, bounds.max_y - bounds.min_y);
        const double margin = std::max(extent, 2.0 * reach) + positions.block_size;
        const double whole = extent + 2.0 * margin + 2.0 * positions.block_size;
        Lattice lattice;
        lattice.quantum = std::exp2(std::ceil(std::log2(whole / lattice_extent)));
        const auto block = [&](double low, double origin) {
            return static_cast<int32_t>(std::floor((low - margin - origin) / positions.block_size));
        };
        lattice.first_block_x = block(bounds.min_x, positions.origin_x);
        lattice.first_block_y = block(bounds.min_y, positions.origin_y);
        lattice.left = positions.origin_x + lattice.first_block_x * positions.block_size;
        lattice.bottom = positions.origin_y + lattice.first_block_y * positions.block_size;
        const LatticePoint low = lattice.nearest(bounds.min_x, bounds.min_y);
        const LatticePoint high = lattice.nearest(bounds.max_x, bounds.max_y);
        lattice.terrain.add(low);
        lattice.terrain.add(high);
        lattice.clip = {bounds.min_x - margin, bounds.min_y - margin, bounds.max_x + margin,
                        bounds.max_y + margin};
        return lattice;
    }

    Bounds clip;  // what is cut off beyond, metres

    // As the shaders round.
    LatticePoint nearest(double x, double y) const {
        return {static_cast<int32_t>(std::lrint((x - left) / quantum)),
                static_cast<int32_t>(std::lrint((y - bottom) / quantum))};
    }
    double x_of(LatticePoint p) const { return left + quantum * p.x; }
    double y_of(LatticePoint p) const { return bottom + quantum * p.y; }
};

}  // namespace decalgl::loops

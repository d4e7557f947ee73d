// The lattice of volumes: integer places on the map, so that what two triangles share is the same point.
//
//     0 ....[##### terrain #####].... 2^30
//
// Whatever reaches beyond is cut off there.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/lattice_points.h"
#include "decalgl/core/position_grid.h"

namespace decalgl::volume {

using lattice::doubled_area;
using lattice::LatticeBox;
using lattice::LatticePoint;

constexpr int lattice_bits = 30;
constexpr double lattice_extent = 1 << lattice_bits;

struct Vector2 {
    double x = 0.0;
    double y = 0.0;
};

struct Lattice {
    double left = 0.0;  // metres, of (0, 0)
    double bottom = 0.0;
    double quantum = 1.0;  // metres, a power of two

    // The terrain lies in the middle half.
    static Lattice over(const Bounds& bounds) {
        const double extent = std::max({bounds.max_x - bounds.min_x, bounds.max_y - bounds.min_y, 1e-3});
        Lattice lattice;
        lattice.quantum = std::exp2(std::ceil(std::log2(extent)) + 1.0 - lattice_bits);
        const auto corner = [&](double low, double high) {
            const double first = 0.5 * (low + high) - 0.5 * lattice_extent * lattice.quantum;
            return std::floor(first / lattice.quantum) * lattice.quantum;
        };
        lattice.left = corner(bounds.min_x, bounds.max_x);
        lattice.bottom = corner(bounds.min_y, bounds.max_y);
        return lattice;
    }

    // In quanta, not rounded.
    Vector2 place(double x, double y) const { return {(x - left) / quantum, (y - bottom) / quantum}; }
};

inline bool on_lattice(Vector2 p) {
    return p.x >= 0.0 && p.y >= 0.0 && p.x <= lattice_extent && p.y <= lattice_extent;
}

inline LatticePoint rounded(Vector2 p) {
    return {static_cast<int32_t>(std::lrint(p.x)), static_cast<int32_t>(std::lrint(p.y))};
}

}  // namespace decalgl::volume

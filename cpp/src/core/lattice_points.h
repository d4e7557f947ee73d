// Places on an integer lattice, and boxes of them: everything here is exact.
//
// A technique lays its lattice as it needs it, over the terrain and a margin; places are within 2^31 of each other.
#pragma once

#include <algorithm>
#include <cstdint>

namespace decalgl::lattice {

struct LatticePoint {
    int32_t x;
    int32_t y;
};

inline bool operator==(LatticePoint a, LatticePoint b) {
    return a.x == b.x && a.y == b.y;
}
inline bool operator!=(LatticePoint a, LatticePoint b) {
    return !(a == b);
}

// Twice the signed area of a, b, c: above 0 where they turn left.
inline int64_t doubled_area(LatticePoint a, LatticePoint b, LatticePoint c) {
    return (int64_t{b.x} - a.x) * (int64_t{c.y} - a.y) - (int64_t{b.y} - a.y) * (int64_t{c.x} - a.x);
}

// Holds its border; empty where a minimum is above its maximum.
struct LatticeBox {
    int32_t min_x = INT32_MAX;
    int32_t min_y = INT32_MAX;
    int32_t max_x = INT32_MIN;
    int32_t max_y = INT32_MIN;

    void add(LatticePoint p) { add(LatticeBox{p.x, p.y, p.x, p.y}); }
    void add(const LatticeBox& other) {
        min_x = std::min(min_x, other.min_x);
        min_y = std::min(min_y, other.min_y);
        max_x = std::max(max_x, other.max_x);
        max_y = std::max(max_y, other.max_y);
    }
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

inline LatticeBox common(const LatticeBox& a, const LatticeBox& b) {
    return {std::max(a.min_x, b.min_x), std::max(a.min_y, b.min_y), std::min(a.max_x, b.max_x),
            std::min(a.max_y, b.max_y)};
}

}  // namespace decalgl::lattice

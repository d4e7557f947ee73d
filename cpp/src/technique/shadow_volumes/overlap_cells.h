// A coarse grid over the map, in which triangles that may lie over each other meet.
#pragma once

#include <algorithm>
#include <cmath>

#include "technique/shadow_volumes/lattice.h"

namespace decalgl::volume {

struct Triangle {
    LatticePoint a;
    LatticePoint b;
    LatticePoint c;

    LatticeBox box() const {
        LatticeBox box;
        box.add(a);
        box.add(b);
        box.add(c);
        return box;
    }
};

class OverlapCells {
public:
    // About as many cells as there are triangles, over the middle half of the lattice, where the terrain is.
    explicit OverlapCells(uint64_t triangles) {
        while (bits_ < 10 && (uint64_t{1} << (2 * bits_)) < triangles)
            ++bits_;
        shift_ = lattice_bits - 1 - bits_;
    }

    size_t count() const { return size_t{1} << (2 * bits_); }

    // Calls back with each cell that the triangle may touch. What lies beyond the cells is in the outermost ones.
    template <typename CellFn>
    void for_each(const Triangle& triangle, CellFn add) const {
        const LatticeBox box = triangle.box();
        const int left = cell_at(box.min_x), right = cell_at(box.max_x);
        const int bottom = cell_at(box.min_y), top = cell_at(box.max_y);
        for (int y = bottom; y <= top; ++y)
            for (int x = left; x <= right; ++x)
                if ((left == right && bottom == top) || is_outermost(x, y) || touches(triangle, x, y))
                    add((static_cast<size_t>(y) << bits_) + static_cast<size_t>(x));
    }

private:
    int cell_at(int32_t place) const {
        const int32_t first = 1 << (lattice_bits - 2);
        return std::clamp((place - first) >> shift_, 0, (1 << bits_) - 1);
    }
    bool is_outermost(int x, int y) const {
        const int last = (1 << bits_) - 1;
        return x == 0 || y == 0 || x == last || y == last;
    }
    // Whether no side of the triangle has the whole cell outside.
    bool touches(const Triangle& t, int x, int y) const {
        const double size = std::ldexp(1.0, shift_);
        const double cx = std::ldexp(1.0, lattice_bits - 2) + (x + 0.5) * size;
        const double cy = std::ldexp(1.0, lattice_bits - 2) + (y + 0.5) * size;
        const auto reaches = [&](LatticePoint p, LatticePoint q) {
            const double dx = double(q.x) - p.x, dy = double(q.y) - p.y;
            return dx * (cy - p.y) - dy * (cx - p.x) + 0.5 * size * (std::abs(dx) + std::abs(dy)) >= 0.0;
        };
        return reaches(t.a, t.b) && reaches(t.b, t.c) && reaches(t.c, t.a);
    }

    int bits_ = 4;
    int shift_ = 0;
};

// Whether two triangles, counter-clockwise, share more than a border.
inline bool lie_over_each_other(const Triangle& s, const Triangle& t) {
    const auto parted_by = [](const Triangle& own, const Triangle& other) {
        const auto outside = [&](LatticePoint p, LatticePoint q) {
            return doubled_area(p, q, other.a) <= 0 && doubled_area(p, q, other.b) <= 0 &&
                   doubled_area(p, q, other.c) <= 0;
        };
        return outside(own.a, own.b) || outside(own.b, own.c) || outside(own.c, own.a);
    };
    return !parted_by(s, t) && !parted_by(t, s);
}

}  // namespace decalgl::volume

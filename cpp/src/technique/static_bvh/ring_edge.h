// Edges of rings, decided exactly.
//
// An edge a-b goes upwards and owns the rows a.y <= y < b.y. In each it has a crossing: the first lattice
// point at or right of it. A point is inside when an odd number of edges cross its row at or left of it; so
// each lattice point lies in exactly one of two neighbours, whatever box the edge is looked at in.
//
//       y            b         crossing(y) = a.x + ceil((y - a.y) * dx / dy)
//       |        . x
//       |      . x             passing_row(x): the first row whose crossing lies beyond x, seen upwards;
//       |   . x                the crossings are in order, so a box takes a run of rows
//       |  a
//
// Level edges own no row. They count where a border is crossed: the states above and below differ there.
#pragma once

#include <algorithm>
#include <cstdint>

#include "technique/static_bvh/lattice.h"

namespace decalgl::bvh {

// Two places in the vertices: the lower end first, or the left one of a level edge.
struct Edge {
    uint32_t a;
    uint32_t b;
};

inline int64_t floor_of_ratio(int64_t value, int64_t divisor) {
    return value / divisor - (value % divisor < 0 ? 1 : 0);
}

inline int64_t ceiling_of_ratio(int64_t value, int64_t divisor) {
    return value / divisor + (value % divisor > 0 ? 1 : 0);
}

class RingEdge {
public:
    RingEdge(LatticePoint a, LatticePoint b)
        : x_(a.x), y_(a.y), dx_(int64_t{b.x} - a.x), dy_(int64_t{b.y} - a.y) {}

    bool owns_row(int64_t y) const { return y_ <= y && y < y_ + dy_; }
    int64_t crossing(int64_t y) const { return x_ + ceiling_of_ratio((y - y_) * dx_, dy_); }

    // Whether it has an end at or left of x, and one beyond.
    bool passes(int64_t x) const { return (x_ <= x) != (x_ + dx_ <= x); }

    // The row from which on the crossings lie on the other side of x: beyond it for an edge that leans to the
    // right, at or left of it for one that leans to the left. The end row where none does.
    int64_t passing_row(int64_t x) const {
        const int64_t rows =
            dx_ > 0 ? floor_of_ratio((x - x_) * dy_, dx_) + 1 : ceiling_of_ratio((x_ - x) * dy_, -dx_);
        return y_ + std::clamp<int64_t>(rows, 0, dy_);
    }

    // Rows [first, end) whose crossings lie in a box, right of its left border.
    struct Rows {
        int64_t first;
        int64_t end;
    };
    Rows rows_in(const LatticeBox& box) const {
        const Rows rows = rows_between(box);
        return {std::max<int64_t>(rows.first, box.min_y),
                std::min<int64_t>(rows.end, int64_t{box.max_y} + 1)};
    }

    // Whether it may decide anything about the points of a box: rows in it, or a border within it passed.
    bool concerns(const LatticeBox& box) const {
        if (y_ > box.max_y || y_ + dy_ <= box.min_y)
            return false;
        const Rows rows = rows_between(box);
        return rows.first <= rows.end && rows.first <= box.max_y && rows.end > box.min_y;
    }

    // The row above which the state of the points at x differs, where it passes x.
    bool turns(int64_t x, int64_t above, int64_t up_to) const {
        if (!passes(x))
            return false;
        const int64_t row = passing_row(x);
        return above < row && row <= up_to;
    }

private:
    // Rows whose crossings lie between a box's borders, at any height; first > end where there are none, even
    // for level edges.
    Rows rows_between(const LatticeBox& box) const {
        const int64_t low = std::min(x_, x_ + dx_), high = std::max(x_, x_ + dx_);
        if (dx_ == 0 ? dy_ == 0 || low <= box.min_x || low > box.max_x : low > box.max_x || high <= box.min_x)
            return {1, 0};
        // Short edges lie between the borders as a rule, and need no division.
        const bool cut_left = low <= box.min_x, cut_right = high > box.max_x;
        const int64_t left = cut_left ? passing_row(box.min_x) : dx_ < 0 ? y_ + dy_ : y_;
        const int64_t right = cut_right ? passing_row(box.max_x) : dx_ < 0 ? y_ : y_ + dy_;
        return dx_ < 0 ? Rows{right, left} : Rows{left, right};
    }

    int64_t x_;
    int64_t y_;
    int64_t dx_;
    int64_t dy_;
};

}  // namespace decalgl::bvh

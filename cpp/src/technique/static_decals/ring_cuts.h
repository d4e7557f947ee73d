// Ring edges cut at the borders of squares, buckets first and cells later.
//
//     an edge through three cells                     its pieces
//
//     +---------+---------+---------+                 +---------+---------+---------+
//     |         |         |     ___-o                 |         |        c|c    ___-o
//     |         |     ___---''''    |       ──▶       |         |b    ___-|-''''    |
//     |   __---''''''   |         |                   |   __---'|'''''    |         |
//     o---      |         |         |                 o---     b|         |         |
//     +---------+---------+---------+                 +---------+---------+---------+
//
// An edge has one direction for this, from left to right and upwards where it is vertical, whatever the ring's. Every cut is
// worked out from the whole edge and rounded onto the lattice, so it is the same point for both polygons that
// share the edge, for both squares at the border, and for buckets as for the cells in them. Cuts are monotone
// along the edge, as each rounding is. A border between squares belongs to the right and the upper one.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "technique/static_decals/bucket_grid.h"

namespace decalgl {

class RingEdge {
public:
    // Ends in any order, not the same point.
    RingEdge(LatticePoint from, LatticePoint to)
        : reversed_(to.x < from.x || (to.x == from.x && to.y < from.y)) {
        a_ = reversed_ ? to : from;
        b_ = reversed_ ? from : to;
    }

    // Whether the ring runs against the direction of the pieces.
    bool reversed() const { return reversed_; }

    // Calls on_piece(column, row, from, to) for the pieces in `range`, in the edge's direction. With `below`, all that
    // lies below the range is in row first_row - 1, as one piece a column.
    template <typename OnPiece>
    void cut(const SquareRange& range, bool below, OnPiece on_piece) const {
        // What lies along the range's left border decides nothing in it.
        if (b_.x <= range.border(range.first_column) || a_.x >= range.border(range.last_column + 1) ||
            std::min(a_.y, b_.y) >= range.border(range.last_row + 1))
            return;
        const int64_t first = std::clamp(a_.x >> range.bits, range.first_column, range.last_column);
        const int64_t last = std::clamp((b_.x - 1) >> range.bits, first, range.last_column);
        LatticePoint start = a_.x < range.border(first) ? at_x(range.border(first)) : a_;
        for (int64_t column = first; column <= last; ++column) {
            const int64_t right = range.border(column + 1);
            const LatticePoint end = b_.x <= right ? b_ : at_x(right);
            cut_column(range, below, column, start, end, on_piece);
            start = end;
        }
    }

private:
    LatticePoint at_x(int64_t x) const {
        const double t = static_cast<double>(x - a_.x) / static_cast<double>(b_.x - a_.x);
        return {x, a_.y + std::lrint(t * static_cast<double>(b_.y - a_.y))};
    }

    // Kept in its column, which rounding may only touch.
    LatticePoint at_y(int64_t y, LatticePoint start, LatticePoint end) const {
        const double t = static_cast<double>(y - a_.y) / static_cast<double>(b_.y - a_.y);
        return {std::clamp(a_.x + std::lrint(t * static_cast<double>(b_.x - a_.x)), start.x, end.x), y};
    }

    template <typename OnPiece>
    void cut_column(const SquareRange& range, bool below, int64_t column, LatticePoint start,
                    LatticePoint end, OnPiece& on_piece) const {
        const auto row_from = [&](int64_t low) { return low >> range.bits; };
        const auto row_to = [&](int64_t low, int64_t high) {
            return std::max(row_from(low), (high - 1) >> range.bits);
        };
        const bool rises = start.y <= end.y;
        const int64_t low = rises ? start.y : end.y;
        const int64_t high = rises ? end.y : start.y;
        const int64_t lowest = below ? range.first_row - 1 : range.first_row;
        const int64_t first = std::clamp(row_from(low), lowest, range.last_row + 1);
        const int64_t last = std::clamp(row_to(low, high), below ? lowest : lowest - 1, range.last_row);
        if (first > last)
            return;
        const auto bottom_of = [&](int64_t row) {
            return row < range.first_row || range.border(row) <= low ? (rises ? start : end)
                                                                     : at_y(range.border(row), start, end);
        };
        const auto top_of = [&](int64_t row) {
            return range.border(row + 1) >= high ? (rises ? end : start)
                                                 : at_y(range.border(row + 1), start, end);
        };
        if (rises) {
            LatticePoint from = bottom_of(first);
            for (int64_t row = first; row <= last; ++row) {
                const LatticePoint to = top_of(row);
                on_piece(column, row, from, to);
                from = to;
            }
        } else {
            LatticePoint from = top_of(last);
            for (int64_t row = last; row >= first; --row) {
                const LatticePoint to = bottom_of(row);
                on_piece(column, row, from, to);
                from = to;
            }
        }
    }

    bool reversed_;
    LatticePoint a_;
    LatticePoint b_;
};

}  // namespace decalgl

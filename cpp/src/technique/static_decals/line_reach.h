// The squares that a line segment's stroke may touch, buckets first and cells later: column by column, the rows that the
// segment reaches there when it is widened by a square.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/segment_interval.h"
#include "technique/static_decals/bucket_grid.h"

namespace decalgl {

// Calls on_square(column, row) for the squares of `range` within `reach` quanta of the segment.
template <typename OnSquare>
void for_each_square_near(LatticePoint a, LatticePoint b, int64_t reach, const SquareRange& range,
                          OnSquare on_square) {
    const auto square_of = [&](int64_t quanta) { return quanta >> range.bits; };
    const int64_t first_column = std::max(square_of(std::min(a.x, b.x) - reach), range.first_column);
    const int64_t last_column = std::min(square_of(std::max(a.x, b.x) + reach), range.last_column);
    const int64_t first_row = std::max(square_of(std::min(a.y, b.y) - reach), range.first_row);
    const int64_t last_row = std::min(square_of(std::max(a.y, b.y) + reach), range.last_row);
    if (first_column >= last_column || first_row >= last_row) {
        for (int64_t column = first_column; column <= last_column; ++column)
            for (int64_t row = first_row; row <= last_row; ++row)
                on_square(column, row);
        return;
    }
    const auto ax = static_cast<double>(a.x), ay = static_cast<double>(a.y);
    const double dx = static_cast<double>(b.x) - ax, dy = static_cast<double>(b.y) - ay;
    for (int64_t column = first_column; column <= last_column; ++column) {
        SegmentInterval inside;
        inside.clip(ax, dx, static_cast<double>(range.border(column) - reach),
                    static_cast<double>(range.border(column + 1) + reach));
        if (inside.first > inside.last)
            continue;
        const auto y0 = static_cast<int64_t>(ay + inside.first * dy);
        const auto y1 = static_cast<int64_t>(ay + inside.last * dy);
        // One quantum more, for the rounding towards zero.
        const int64_t low = std::max(square_of(std::min(y0, y1) - reach - 1), first_row);
        const int64_t high = std::min(square_of(std::max(y0, y1) + reach + 1), last_row);
        for (int64_t row = low; row <= high; ++row)
            on_square(column, row);
    }
}

}  // namespace decalgl

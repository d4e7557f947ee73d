#include "technique/static_decals/line_cells.h"

#include <algorithm>
#include <cmath>

namespace decalgl {
namespace {

enum class Wanted { covered_cells, pieces };

struct Stroke {
    double half_width;  // quanta
    int64_t reach;      // half width, rounded up
    int scale;
    Wanted wanted;

    Stroke(double half_width_in_quanta, Wanted what)
        : half_width(half_width_in_quanta),
          reach(static_cast<int64_t>(std::ceil(half_width_in_quanta))),
          scale(line_scale(half_width_in_quanta)),
          wanted(what) {}

    bool can_cover_cells() const { return half_width >= CELL_QUANTA * 0.7072; }
};

// The part of a segment inside a box, as parameters along it; empty when first > last.
struct Interval {
    double first = 0.0;
    double last = 1.0;

    void clip(double start, double step, double low, double high) {
        if (step == 0.0) {
            if (start < low || start > high)
                last = -1.0;
            return;
        }
        const double t0 = (low - start) / step;
        const double t1 = (high - start) / step;
        first = std::max(first, std::min(t0, t1));
        last = std::min(last, std::max(t0, t1));
    }
};

bool within(double x, double y, LatticePoint a, LatticePoint b, double radius) {
    const double dx = static_cast<double>(b.x - a.x);
    const double dy = static_cast<double>(b.y - a.y);
    const double px = x - static_cast<double>(a.x);
    const double py = y - static_cast<double>(a.y);
    const double length2 = dx * dx + dy * dy;
    const double t = length2 > 0.0 ? std::clamp((px * dx + py * dy) / length2, 0.0, 1.0) : 0.0;
    const double ex = px - t * dx;
    const double ey = py - t * dy;
    return ex * ex + ey * ey <= radius * radius;
}

// A stroke is convex, so it covers a cell when it covers the four corners.
bool covers_cell(LatticePoint a, LatticePoint b, double half_width, int32_t column, int32_t row) {
    const double left = static_cast<double>(column) * CELL_QUANTA;
    const double bottom = static_cast<double>(row) * CELL_QUANTA;
    return within(left, bottom, a, b, half_width) && within(left + CELL_QUANTA, bottom, a, b, half_width) &&
           within(left, bottom + CELL_QUANTA, a, b, half_width) &&
           within(left + CELL_QUANTA, bottom + CELL_QUANTA, a, b, half_width);
}

void add_clipped_piece(LatticePoint a, LatticePoint b, const Stroke& stroke, int32_t column, int32_t row,
                       CellRecords& records) {
    const double unit = std::ldexp(1.0, -stroke.scale);
    const double ax = static_cast<double>(a.x - int64_t{column} * CELL_QUANTA) * unit + COORDINATE_BIAS;
    const double ay = static_cast<double>(a.y - int64_t{row} * CELL_QUANTA) * unit + COORDINATE_BIAS;
    const double bx = static_cast<double>(b.x - int64_t{column} * CELL_QUANTA) * unit + COORDINATE_BIAS;
    const double by = static_cast<double>(b.y - int64_t{row} * CELL_QUANTA) * unit + COORDINATE_BIAS;
    Interval kept;
    kept.clip(ax, bx - ax, 0.0, COORDINATE_MAX);
    kept.clip(ay, by - ay, 0.0, COORDINATE_MAX);
    if (kept.first > kept.last)
        return;
    const auto at = [](double start, double end, double t) {
        const double value = t <= 0.0 ? start : t >= 1.0 ? end : start + t * (end - start);
        return static_cast<uint16_t>(std::lrint(std::clamp(value, 0.0, double{COORDINATE_MAX})));
    };
    records.add_piece(records.grid().cell_index(column, row), at(ax, bx, kept.first), at(ay, by, kept.first),
                      at(ax, bx, kept.last), at(ay, by, kept.last));
}

void add_piece(LatticePoint a, LatticePoint b, const Stroke& stroke, int32_t column, int32_t row,
               CellRecords& records) {
    const bool covers = stroke.can_cover_cells() && covers_cell(a, b, stroke.half_width, column, row);
    if (stroke.wanted == Wanted::covered_cells) {
        if (covers)
            records.add_covered(column, row, row);
        return;
    }
    if (covers)
        return;
    const int64_t left = int64_t{column} * CELL_QUANTA - COORDINATE_BIAS;
    const int64_t bottom = int64_t{row} * CELL_QUANTA - COORDINATE_BIAS;
    const int64_t x0 = a.x - left, y0 = a.y - bottom, x1 = b.x - left, y1 = b.y - bottom;
    const bool fits =
        stroke.scale == 0 && ((x0 | y0 | x1 | y1) & ~int64_t{0xFFFF}) == 0 && x0 != covers_marker;
    if (fits)
        records.add_piece(records.grid().cell_index(column, row), static_cast<uint16_t>(x0),
                          static_cast<uint16_t>(y0), static_cast<uint16_t>(x1), static_cast<uint16_t>(y1));
    else
        add_clipped_piece(a, b, stroke, column, row, records);
}

// The cells of a row or column of `count` that reach from `low` to `high` touches, in quanta.
struct CellSpan {
    int32_t first;
    int32_t last;

    CellSpan(int64_t low, int64_t high, int32_t count)
        : first(static_cast<int32_t>(std::clamp<int64_t>(low >> CELL_BITS, 0, count))),
          last(static_cast<int32_t>(std::clamp<int64_t>(high >> CELL_BITS, -1, count - 1))) {}
};

// Column by column: the rows that the widened segment reaches there.
void add_segment(LatticePoint a, LatticePoint b, const Stroke& stroke, CellRecords& records) {
    const CellGrid& grid = records.grid();
    const int64_t reach = stroke.reach;
    const CellSpan columns(std::min(a.x, b.x) - reach, std::max(a.x, b.x) + reach, grid.columns);
    const CellSpan rows(std::min(a.y, b.y) - reach, std::max(a.y, b.y) + reach, grid.rows);
    if (columns.first == columns.last || rows.first == rows.last) {
        for (int32_t column = columns.first; column <= columns.last; ++column)
            for (int32_t row = rows.first; row <= rows.last; ++row)
                add_piece(a, b, stroke, column, row, records);
        return;
    }
    const auto ax = static_cast<double>(a.x), ay = static_cast<double>(a.y);
    const double dx = static_cast<double>(b.x) - ax, dy = static_cast<double>(b.y) - ay;
    for (int32_t column = columns.first; column <= columns.last; ++column) {
        Interval inside;
        inside.clip(ax, dx, static_cast<double>(int64_t{column} * CELL_QUANTA - reach),
                    static_cast<double>(int64_t{column + 1} * CELL_QUANTA + reach));
        if (inside.first > inside.last)
            continue;
        const auto y0 = static_cast<int64_t>(ay + inside.first * dy);
        const auto y1 = static_cast<int64_t>(ay + inside.last * dy);
        // One quantum more, for the rounding towards zero.
        const CellSpan here(std::min(y0, y1) - reach - 1, std::max(y0, y1) + reach + 1, grid.rows);
        for (int32_t row = here.first; row <= here.last; ++row)
            add_piece(a, b, stroke, column, row, records);
    }
}

void add_part(Span<const double> coordinates, const Stroke& stroke, CellRecords& records) {
    const Lattice lattice(records.grid());
    const size_t count = coordinates.size() / 2;
    if (count == 0)
        return;
    LatticePoint previous = lattice.nearest(coordinates[0], coordinates[1]);
    bool drawn = false;
    for (size_t i = 1; i < count; ++i) {
        const LatticePoint next = lattice.nearest(coordinates[2 * i], coordinates[2 * i + 1]);
        if (next == previous)
            continue;
        add_segment(previous, next, stroke, records);
        previous = next;
        drawn = true;
    }
    // A line shorter than a quantum is still a dot.
    if (!drawn)
        add_segment(previous, previous, stroke, records);
}

}  // namespace

int line_scale(double half_width_in_quanta) {
    constexpr double reach = COORDINATE_BIAS - 2;
    return half_width_in_quanta <= reach
               ? 0
               : static_cast<int>(std::ceil(std::log2(half_width_in_quanta / reach)));
}

void mark_covered_cells(Span<const double> coordinates, double half_width, CellRecords& records) {
    const Stroke stroke(half_width, Wanted::covered_cells);
    if (stroke.can_cover_cells())
        add_part(coordinates, stroke, records);
}

void add_line_pieces(Span<const double> coordinates, double half_width, CellRecords& records) {
    add_part(coordinates, Stroke(half_width, Wanted::pieces), records);
}

}  // namespace decalgl

#include "technique/static_decals/line_cells.h"

#include <algorithm>
#include <cmath>

namespace decalgl {
namespace {

enum class Wanted { covered_cells, pieces };

struct Stroke {
    double half_width;  // quanta
    int scale;
    Wanted wanted;

    bool can_cover_cells() const { return half_width >= CELL_QUANTA * 0.7072; }
};

// The part of a segment inside a box, as parameters along it; empty when first > last.
struct Interval {
    double first = 0.0;
    double last = 1.0;

    void clip(double start, double step, double low, double high) {
        if (step == 0.0) {
            if (start < low || start > high) last = -1.0;
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
    if (kept.first > kept.last) return;
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
        if (covers) records.add_covered(column, row, row);
        return;
    }
    if (covers) return;
    const int64_t left = int64_t{column} * CELL_QUANTA - COORDINATE_BIAS;
    const int64_t bottom = int64_t{row} * CELL_QUANTA - COORDINATE_BIAS;
    const auto fits = [](int64_t value) { return value >= 0 && value <= COORDINATE_MAX; };
    if (stroke.scale == 0 && fits(a.x - left) && fits(a.y - bottom) && fits(b.x - left) && fits(b.y - bottom))
        records.add_piece(records.grid().cell_index(column, row), static_cast<uint16_t>(a.x - left),
                          static_cast<uint16_t>(a.y - bottom), static_cast<uint16_t>(b.x - left),
                          static_cast<uint16_t>(b.y - bottom));
    else
        add_clipped_piece(a, b, stroke, column, row, records);
}

int32_t cell_of(double quanta, int32_t count) {
    return static_cast<int32_t>(std::clamp(std::floor(quanta / CELL_QUANTA), -1.0, static_cast<double>(count)));
}

// Column by column: the rows that the widened segment reaches there.
void add_segment(LatticePoint a, LatticePoint b, const Stroke& stroke, CellRecords& records) {
    const CellGrid& grid = records.grid();
    const double r = stroke.half_width;
    const auto ax = static_cast<double>(a.x), ay = static_cast<double>(a.y);
    const auto bx = static_cast<double>(b.x), by = static_cast<double>(b.y);
    const int32_t first_column = std::max(cell_of(std::min(ax, bx) - r, grid.columns), 0);
    const int32_t last_column = std::min(cell_of(std::max(ax, bx) + r, grid.columns), grid.columns - 1);
    for (int32_t column = first_column; column <= last_column; ++column) {
        Interval inside;
        if (first_column != last_column)
            inside.clip(ax, bx - ax, static_cast<double>(column) * CELL_QUANTA - r,
                        static_cast<double>(column + 1) * CELL_QUANTA + r);
        if (inside.first > inside.last) continue;
        const double y0 = ay + inside.first * (by - ay);
        const double y1 = ay + inside.last * (by - ay);
        const int32_t first_row = std::max(cell_of(std::min(y0, y1) - r, grid.rows), 0);
        const int32_t last_row = std::min(cell_of(std::max(y0, y1) + r, grid.rows), grid.rows - 1);
        for (int32_t row = first_row; row <= last_row; ++row) add_piece(a, b, stroke, column, row, records);
    }
}

void add_part(Span<const double> coordinates, const Stroke& stroke, CellRecords& records) {
    const CellGrid& grid = records.grid();
    const size_t count = coordinates.size() / 2;
    if (count == 0) return;
    LatticePoint previous{grid.lattice_x(coordinates[0]), grid.lattice_y(coordinates[1])};
    bool drawn = false;
    for (size_t i = 1; i < count; ++i) {
        const LatticePoint next{grid.lattice_x(coordinates[2 * i]), grid.lattice_y(coordinates[2 * i + 1])};
        if (next == previous) continue;
        add_segment(previous, next, stroke, records);
        previous = next;
        drawn = true;
    }
    // A line shorter than a quantum is still a dot.
    if (!drawn) add_segment(previous, previous, stroke, records);
}

}  // namespace

int line_scale(double half_width_in_quanta) {
    constexpr double reach = COORDINATE_BIAS - 2;
    return half_width_in_quanta <= reach
               ? 0
               : static_cast<int>(std::ceil(std::log2(half_width_in_quanta / reach)));
}

void mark_covered_cells(Span<const double> coordinates, double half_width, CellRecords& records) {
    const Stroke stroke{half_width, line_scale(half_width), Wanted::covered_cells};
    if (stroke.can_cover_cells()) add_part(coordinates, stroke, records);
}

void add_line_pieces(Span<const double> coordinates, double half_width, CellRecords& records) {
    add_part(coordinates, {half_width, line_scale(half_width), Wanted::pieces}, records);
}

}  // namespace decalgl

#include "technique/static_decals/ring_cells.h"

#include <algorithm>
#include <cmath>

namespace decalgl {
namespace {

// Where the edge a-b is at a given x or y, on the lattice. Monotone in its argument, since every step is.
int64_t y_at(LatticePoint a, LatticePoint b, int64_t x) {
    const double t = static_cast<double>(x - a.x) / static_cast<double>(b.x - a.x);
    return a.y + std::lrint(t * static_cast<double>(b.y - a.y));
}

int64_t x_at(LatticePoint a, LatticePoint b, int64_t y) {
    const double t = static_cast<double>(y - a.y) / static_cast<double>(b.y - a.y);
    return a.x + std::lrint(t * static_cast<double>(b.x - a.x));
}

int64_t border(int64_t cell) {
    return cell * CELL_QUANTA;
}

int64_t clamp_cell(int64_t quanta, int64_t low, int64_t high) {
    return std::clamp(quanta >> CELL_BITS, low, high);
}

uint16_t local(int64_t quanta, int64_t cell) {
    return static_cast<uint16_t>(quanta - border(cell) + COORDINATE_BIAS);
}

}  // namespace

void RingCells::add_ring(Span<const double> coordinates) {
    const Lattice lattice(records_->grid());
    const size_t count = coordinates.size() / 2;
    if (count < 3)
        return;
    LatticePoint previous = lattice.nearest(coordinates[2 * count - 2], coordinates[2 * count - 1]);
    for (size_t i = 0; i < count; ++i) {
        const LatticePoint next = lattice.nearest(coordinates[2 * i], coordinates[2 * i + 1]);
        const bool forward = previous.x < next.x || (previous.x == next.x && previous.y < next.y);
        if (forward)
            add_edge(previous, next);
        else if (!(previous == next))
            add_edge(next, previous);
        previous = next;
    }
}

// a is left of b, or below it.
void RingCells::add_edge(LatticePoint a, LatticePoint b) {
    const CellGrid& grid = records_->grid();
    if (std::min(a.y, b.y) >= border(grid.rows) || b.x <= 0 || a.x >= border(grid.columns))
        return;
    const int64_t first = clamp_cell(a.x, 0, grid.columns - 1);
    const int64_t last = std::max(first, clamp_cell(b.x - 1, 0, grid.columns - 1));
    LatticePoint start = a;
    if (a.x < border(first))
        start = {border(first), y_at(a, b, border(first))};
    for (int64_t column = first; column <= last; ++column) {
        const int64_t right = border(column + 1);
        const LatticePoint end = b.x <= right ? b : LatticePoint{right, y_at(a, b, right)};
        add_column_piece(static_cast<int32_t>(column), start, end);
        start = end;
    }
}

// A piece between the borders of one column, a left of b or straight below it: cut into rows from the bottom
// up.
void RingCells::add_column_piece(int32_t column, LatticePoint a, LatticePoint b) {
    const CellGrid& grid = records_->grid();
    const LatticePoint low = a.y <= b.y ? a : b;
    const LatticePoint high = a.y <= b.y ? b : a;
    const int64_t left = border(column);
    if (low.y >= border(grid.rows))
        return;
    if (high.y < 0) {
        if ((low.x == left) != (high.x == left))
            add_crossing(column, -1);
        return;
    }
    LatticePoint start = low;
    if (low.y < 0) {
        start = {x_at(a, b, 0), 0};
        if ((low.x == left) != (start.x == left))
            add_crossing(column, -1);
    }
    const int64_t first = start.y >> CELL_BITS;
    const int64_t last = std::max(first, clamp_cell(high.y - 1, 0, grid.rows - 1));
    for (int64_t row = first; row <= last; ++row) {
        const int64_t top = border(row + 1);
        const LatticePoint end = high.y <= top ? high : LatticePoint{x_at(a, b, top), top};
        add_cell_piece(column, static_cast<int32_t>(row), start, end);
        start = end;
    }
}

void RingCells::add_cell_piece(int32_t column, int32_t row, LatticePoint low, LatticePoint high) {
    const int64_t left = border(column);
    const int64_t right = border(column + 1);
    // A piece on a border crosses neither the walk up the left border nor a row: it decides nothing.
    if (low.x == high.x && (low.x == left || low.x == right))
        return;
    const bool leaves_border = (low.x == left) != (high.x == left);
    if (leaves_border)
        add_crossing(column, row);
    if (low.y == high.y && !leaves_border)
        return;
    records_->add_piece(records_->grid().cell_index(column, row), local(low.x, column), local(low.y, row),
                        local(high.x, column), local(high.y, row));
}

void RingCells::add_crossing(int32_t column, int32_t row) {
    crossings_.push_back(static_cast<uint32_t>(column) << 16 | static_cast<uint32_t>(row + 1));
}

// Up a column, every crossing turns inside to outside and back; the cells above it know their corner by that.
void RingCells::finish_feature() {
    std::sort(crossings_.begin(), crossings_.end());
    const int32_t rows = records_->grid().rows;
    for (size_t i = 0; i < crossings_.size();) {
        const uint32_t column = crossings_[i] >> 16;
        const auto row_of = [&](size_t k) { return static_cast<int32_t>(crossings_[k] & 0xFFFFu) - 1; };
        const int32_t first = row_of(i) + 1;
        const bool has_end = i + 1 < crossings_.size() && crossings_[i + 1] >> 16 == column;
        const int32_t last = has_end ? row_of(i + 1) : rows - 1;
        if (first <= last)
            records_->add_covered(static_cast<int32_t>(column), first, last);
        i += has_end ? 2 : 1;
    }
    crossings_.clear();
}

}  // namespace decalgl

#include "technique/static_decals/line_cells.h"

#include <algorithm>
#include <cmath>

#include "technique/static_decals/line_reach.h"

namespace decalgl {
namespace {

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
bool covers_cell(LatticePoint a, LatticePoint b, double half_width, const SquareRange& cells, int64_t column,
                 int64_t row) {
    const auto left = static_cast<double>(cells.border(column)),
               right = static_cast<double>(cells.border(column + 1));
    const auto bottom = static_cast<double>(cells.border(row)),
               top = static_cast<double>(cells.border(row + 1));
    return within(left, bottom, a, b, half_width) && within(right, bottom, a, b, half_width) &&
           within(left, top, a, b, half_width) && within(right, top, a, b, half_width);
}

uint32_t word_of(uint32_t x, uint32_t y) {
    return x | y << COORDINATE_BITS;
}

}  // namespace

void LineCells::begin(uint32_t slot, float half_width) {
    const int64_t last = (int64_t{1} << lists_->level()) - 1;
    cells_ = {cell_bits(lists_->level()), 0, 0, last, last};
    slot_ = slot;
    half_width_ = static_cast<double>(half_width);
    reach_ = static_cast<int64_t>(std::ceil(half_width));
    scale_ = line_scale(half_width);
    covers_cells_ = false;
}

void LineCells::mark_covered_cells(Span<const LatticePoint> points) {
    if (half_width_ < 0.7071 * static_cast<double>(cells_.border(1)))
        return;
    for (size_t i = 0; i < points.size(); ++i) {
        const LatticePoint a = points[i == 0 ? 0 : i - 1], b = points[i];
        for_each_square_near(a, b, reach_, cells_, [&](int64_t column, int64_t row) {
            if (!covers_cell(a, b, half_width_, cells_, column, row))
                return;
            lists_->add_covers(lists_->cell_at(column, row), slot_, LINE);
            covers_cells_ = true;
        });
    }
}

void LineCells::add_edges(Span<const LatticePoint> points) {
    const auto add = [&](LatticePoint a, LatticePoint b) {
        for_each_square_near(a, b, reach_, cells_,
                             [&](int64_t column, int64_t row) { add_edge(a, b, column, row); });
    };
    if (points.size() == 1)
        add(points[0], points[0]);
    for (size_t i = 1; i < points.size(); ++i)
        add(points[i - 1], points[i]);
}

void LineCells::add_edge(LatticePoint a, LatticePoint b, int64_t column, int64_t row) {
    const uint32_t cell = lists_->cell_at(column, row);
    if (covers_cells_ && lists_->is_covered(cell, slot_))
        return;
    const int64_t bias = cell_bias(lists_->level());
    const int64_t left = cells_.border(column), bottom = cells_.border(row);
    const int64_t x0 = a.x - left + bias, y0 = a.y - bottom + bias, x1 = b.x - left + bias,
                  y1 = b.y - bottom + bias;
    if (scale_ == 0 && ((x0 | y0 | x1 | y1) & ~int64_t{COORDINATE_MASK}) == 0) {
        lists_->add_edge(cell, slot_, LINE, word_of(static_cast<uint32_t>(x0), static_cast<uint32_t>(y0)),
                         word_of(static_cast<uint32_t>(x1), static_cast<uint32_t>(y1)));
        return;
    }
    const double unit = std::ldexp(1.0, -scale_), origin = static_cast<double>(bias);
    const double ax = static_cast<double>(a.x - left) * unit + origin,
                 ay = static_cast<double>(a.y - bottom) * unit + origin;
    const double bx = static_cast<double>(b.x - left) * unit + origin,
                 by = static_cast<double>(b.y - bottom) * unit + origin;
    static constexpr double most = COORDINATE_MASK;
    SegmentInterval kept;
    kept.clip(ax, bx - ax, 0.0, most);
    kept.clip(ay, by - ay, 0.0, most);
    if (kept.first > kept.last)
        return;
    const auto word_at = [&](double t) {
        const auto along = [t](double start, double end) {
            const double value = t <= 0.0 ? start : t >= 1.0 ? end : start + t * (end - start);
            return static_cast<uint32_t>(std::lrint(std::clamp(value, 0.0, most)));
        };
        return word_of(along(ax, bx), along(ay, by));
    };
    lists_->add_edge(cell, slot_, LINE, word_at(kept.first), word_at(kept.last));
}

}  // namespace decalgl

#include "technique/static_decals/stroke_cells.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "technique/static_decals/line_reach.h"

namespace decalgl {
namespace {

bool within(double x, double y, LatticePoint a, LatticePoint b, const DecalShape& shape) {
    const double dx = static_cast<double>(b.x - a.x);
    const double dy = static_cast<double>(b.y - a.y);
    const double px = x - static_cast<double>(a.x);
    const double py = y - static_cast<double>(a.y);
    const double length2 = dx * dx + dy * dy;
    const double along = length2 > 0.0 ? (px * dx + py * dy) / length2 : 0.0;
    const double t = std::clamp(along, 0.0, 1.0);
    if (shape.is_joined && (t != along || length2 == 0.0))
        return false;
    const double ex = px - t * dx;
    const double ey = py - t * dy;
    return ex * ex + ey * ey <= double{shape.half_width} * double{shape.half_width};
}

// A bar or a capsule is convex, so it covers a cell when it covers the four corners.
bool covers_cell(LatticePoint a, LatticePoint b, const DecalShape& shape, const SquareRange& cells,
                 int64_t column, int64_t row) {
    const auto left = static_cast<double>(cells.border(column)),
               right = static_cast<double>(cells.border(column + 1));
    const auto bottom = static_cast<double>(cells.border(row)),
               top = static_cast<double>(cells.border(row + 1));
    return within(left, bottom, a, b, shape) && within(right, bottom, a, b, shape) &&
           within(left, top, a, b, shape) && within(right, top, a, b, shape);
}

uint32_t word_of(uint32_t x, uint32_t y) {
    return x | y << COORDINATE_BITS;
}

uint32_t phase_of(double periods, bool begins) {
    const double fraction = periods - std::floor(periods);
    return std::min(static_cast<uint32_t>(fraction * PHASE_ONE), uint32_t{PHASE_ONE - 1}) |
           (begins ? PHASE_LIFTS : 0U);
}

uint32_t bits_of(float value) {
    uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    return bits;
}

// The end that a square cap moves outwards.
LatticePoint lengthened(LatticePoint end, LatticePoint neighbour, double by) {
    const double length = length_of(neighbour, end);
    const double share = length > 0.0 ? by / length : 0.0;
    return {end.x + std::llrint(share * static_cast<double>(end.x - neighbour.x)),
            end.y + std::llrint(share * static_cast<double>(end.y - neighbour.y))};
}

}  // namespace

void StrokeCells::begin(uint32_t slot, const DecalShape& shape, const CellMask* open) {
    const int64_t last = (int64_t{1} << lists_->level()) - 1;
    cells_ = {cell_bits(lists_->level()), 0, 0, last, last};
    slot_ = slot;
    shape_ = &shape;
    open_ = open;
    reach_ = static_cast<int64_t>(std::ceil(shape.half_width));
    covers_cells_ = false;
}

void StrokeCells::mark_covered_cells(Span<const LatticePoint> points) {
    if (!shape_->covers_cells || double{shape_->half_width} < 0.7071 * static_cast<double>(cells_.border(1)))
        return;
    for (size_t i = 0; i < points.size(); ++i) {
        const LatticePoint a = points[i == 0 ? 0 : i - 1], b = points[i];
        for_each_square_near(a, b, reach_, cells_, [&](int64_t column, int64_t row) {
            const uint32_t cell = lists_->cell_at(column, row);
            if (!shows_in(cell) || !covers_cell(a, b, *shape_, cells_, column, row))
                return;
            lists_->add_covers(cell, slot_, LINE);
            covers_cells_ = true;
        });
    }
}

void StrokeCells::add_edges(Span<const LatticePoint> points, const StrokeEnds& ends,
                            Span<const float> slants) {
    if (shape_->is_joined) {
        add_joined(points, ends, slants);
        return;
    }
    const auto add = [&](LatticePoint a, LatticePoint b) {
        for_each_square_near(a, b, reach_, cells_, [&](int64_t column, int64_t row) {
            add_edge({a, b, 0.0}, column, row);
        });
    };
    if (points.size() == 1)
        add(points[0], points[0]);
    for (size_t i = 1; i < points.size(); ++i)
        add(points[i - 1], points[i]);
}

template <typename OnEdge, typename OnDot>
void StrokeCells::for_each_joined(Span<const LatticePoint> points, const StrokeEnds& ends,
                                  Span<const float> slants, OnEdge on_edge, OnDot on_dot) const {
    const double radius = shape_->half_width;
    const bool square = shape_->cap == Cap::square, round = shape_->cap == Cap::round;
    const size_t last = points.size() - 1;
    if (last == 0) {
        if (!ends.begins || !ends.ends)
            return;
        if (round || square)
            on_dot(points[0], ends.periods, true);
        return;
    }
    double periods = ends.periods;
    if (ends.begins && round)
        on_dot(points[0], periods, true);
    for (size_t i = 1; i <= last; ++i) {
        const bool begins = i == 1 && ends.begins, finishes = i == last && ends.ends;
        const float slant = slants.empty() ? 1.0F : std::abs(slants[i]);
        const bool bends = !slants.empty() && slants[i - 1] < 0.0F;
        Edge edge{points[i - 1], points[i], periods, slant, i == 1 && !ends.begins, begins, begins || bends};
        periods += periods_along(edge, length_of(edge.a, edge.b));
        double reach = radius;
        if (!begins)
            reach = std::max(reach, shape_->reach_near(i == 1 ? ends.before : points[i - 2], edge.a, edge.b));
        if (!finishes)
            reach =
                std::max(reach, shape_->reach_near(edge.a, edge.b, i == last ? ends.after : points[i + 1]));
        if (begins && square) {
            edge.a = lengthened(edge.a, edge.b, radius);
            edge.periods -= periods_along(edge, radius);
        }
        if (finishes && square)
            edge.b = lengthened(edge.b, points[i - 1], radius);
        on_edge(edge, reach);
    }
    if (ends.ends && round)
        on_dot(points[last], periods, false);
}

void StrokeCells::add_joined(Span<const LatticePoint> points, const StrokeEnds& ends,
                             Span<const float> slants) {
    for_each_joined(
        points, ends, slants,
        [&](const Edge& edge, double reach) {
            for_each_square_near(edge.a, edge.b, static_cast<int64_t>(std::ceil(reach)), cells_,
                                 [&](int64_t column, int64_t row) { add_edge(edge, column, row); });
        },
        [&](LatticePoint at, double periods, bool begins) {
            for_each_square_near(at, at, reach_, cells_, [&](int64_t column, int64_t row) {
                add_dot(at, periods, begins, lists_->cell_at(column, row), column, row);
            });
        });
}

void StrokeCells::mark_touched_cells(Span<const LatticePoint> points, const StrokeEnds& ends,
                                     CellMask& touched) const {
    const auto mark = [&](LatticePoint a, LatticePoint b, double reach) {
        for_each_square_near(a, b, static_cast<int64_t>(std::ceil(reach)), cells_,
                             [&](int64_t column, int64_t row) { touched[lists_->cell_at(column, row)] = 1; });
    };
    if (shape_->is_joined) {
        for_each_joined(
            points, ends, {}, [&](const Edge& edge, double reach) { mark(edge.a, edge.b, reach); },
            [&](LatticePoint at, double, bool) { mark(at, at, shape_->half_width); });
        return;
    }
    for (size_t i = 0; i < points.size(); ++i)
        mark(points[i == 0 ? 0 : i - 1], points[i], shape_->half_width);
}

void StrokeCells::add_dot(LatticePoint at, double periods, bool begins, uint32_t cell, int64_t column,
                          int64_t row) {
    if (!shows_in(cell) || (covers_cells_ && lists_->is_covered(cell, slot_)))
        return;
    const double unit = std::ldexp(1.0, -shape_->scale), origin = cell_bias(lists_->level());
    const double x = static_cast<double>(at.x - cells_.border(column)) * unit + origin;
    const double y = static_cast<double>(at.y - cells_.border(row)) * unit + origin;
    static constexpr double most = COORDINATE_MASK;
    if (!(x >= 0.0 && x <= most && y >= 0.0 && y <= most))
        return;
    if (begins)
        lists_->lift_pen(cell, slot_);
    lists_->add_dot(cell, slot_,
                    word_of(static_cast<uint32_t>(std::lrint(x)), static_cast<uint32_t>(std::lrint(y))),
                    pattern_words(periods, begins, 1.0F));
}

void StrokeCells::add_edge(const Edge& edge, int64_t column, int64_t row) {
    const LatticePoint a = edge.a, b = edge.b;
    const uint32_t cell = lists_->cell_at(column, row);
    if (!shows_in(cell) || (covers_cells_ && lists_->is_covered(cell, slot_)))
        return;
    const bool patterned = shape_->periods_per_quantum > 0.0;
    if (edge.begins || (patterned && edge.restarts) || shape_->follows_ground)
        lists_->lift_pen(cell, slot_);
    const int64_t bias = cell_bias(lists_->level());
    const int64_t left = cells_.border(column), bottom = cells_.border(row);
    const int64_t x0 = a.x - left + bias, y0 = a.y - bottom + bias, x1 = b.x - left + bias,
                  y1 = b.y - bottom + bias;
    if (shape_->scale == 0 && ((x0 | y0 | x1 | y1) & ~int64_t{COORDINATE_MASK}) == 0) {
        lists_->add_edge(cell, slot_, LINE, word_of(static_cast<uint32_t>(x0), static_cast<uint32_t>(y0)),
                         word_of(static_cast<uint32_t>(x1), static_cast<uint32_t>(y1)),
                         pattern_words(edge.periods, edge.plain, edge.slant));
        return;
    }
    const double unit = std::ldexp(1.0, -shape_->scale), origin = static_cast<double>(bias);
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
    const double periods = edge.periods + periods_along(edge, kept.first * length_of(a, b));
    lists_->add_edge(cell, slot_, LINE, word_at(kept.first), word_at(kept.last),
                     pattern_words(periods, edge.plain, edge.slant));
}

PatternWords StrokeCells::pattern_words(double periods, bool begins, float slant) const {
    PatternWords words;
    if (shape_->follows_ground)
        words.add(bits_of(slant));
    if (shape_->periods_per_quantum > 0.0)
        words.add(phase_of(periods, begins));
    return words;
}

}  // namespace decalgl

// Reads the list of a cell for some points in it at once: the walk of point.glsl on the CPU, to the end. In double precision
// for picking, in single for the many points of levels of detail.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <vector>

#include "technique/static_decals/style_reader.h"
#include "vector/slope.h"

namespace decalgl {

// A cell, and points in quanta from its corner: rows of `side`, each in its own square of the cell, or one anywhere.
template <typename Real>
struct CellPoints {
    int level = 0;
    int64_t bucket_column = 0, bucket_row = 0;
    Vector2 corner{};  // of the cell, in quanta from that of its bucket
    size_t side = 1;
    std::vector<Real> x, y;
};

// Of points, those from `first` to before `last`.
struct PointRange {
    size_t first = 0, last = 0;
};

template <typename Real>
class ListReader {
public:
    // The cell's place may change between lists, its level and its points may not.
    // `slope`: of the ground at the points.
    ListReader(const PreparedDecals& decals, const CellPoints<Real>& cell, const Slope& slope = Slope())
        : decals_(decals),
          cell_(cell),
          slope_(slope),
          bias_(static_cast<Real>(cell_bias(cell.level))),
          at_x_(cell.x.size()),
          at_y_(cell.x.size()),
          shares_(cell.x.size(), none_),
          open_(cell.x.size(), true) {}

    // Calls on_group(slot, style, shares, points) for the decals of a list, topmost first. A share is that of the half
    // width at which the stroke covers the point, 0 where a fill does, and above 1 where nothing does; of other points than
    // those from points.first to before points.last all are.
    template <typename OnGroup>
    void read(Span<const uint32_t> words, OnGroup on_group) {
        bool begun = false;
        follows_clip_ = false;
        for (const uint32_t word : words) {
            if ((word & HEADER) == 0) {
                read_point(word);
                continue;
            }
            if (begun)
                end_group(on_group);
            begun = word != LIST_END;
            if (!begun)
                return;
            begin_group(word);
        }
        if (begun)
            end_group(on_group);
    }

private:
    void begin_group(uint32_t header) {
        slot_ = header & SLOT_MASK;
        is_line_ = (header & LINE) != 0;
        is_clip_ = (header & CLIP) != 0;
        style_ = StyleReader(decals_, slot_);
        if (style_.is(STYLE_THOENY))
            style_.multiply_width(slope_.thoeny_width());
        has_incoming_ = false;
        awaited_ = 0;
        slant_ = 1.0;
        if ((header & COVERS) != 0)
            std::fill(shares_.begin(), shares_.end(), Real(0));
        const bool is_plain_stroke = is_line_ && (header & COVERS) == 0 && !style_.is(STYLE_JOINED);
        met_ = is_plain_stroke ? PointRange{shares_.size(), 0} : PointRange{0, shares_.size()};
        const Real unit = is_line_ ? std::ldexp(Real(1), -style_.scale()) : Real(1);
        const bool is_tangent = is_line_ && style_.is(STYLE_TANGENT);
        if (unit == unit_ && is_tangent == is_tangent_)
            return;
        unit_ = unit;
        is_tangent_ = is_tangent;
        for (size_t i = 0; i < shares_.size(); ++i) {
            at_x_[i] = cell_.x[i] * unit + bias_;
            at_y_[i] = cell_.y[i] * unit + bias_;
            if (is_tangent) {
                const Vector2 on_slope = measured(at(i));
                at_x_[i] = static_cast<Real>(on_slope.x);
                at_y_[i] = static_cast<Real>(on_slope.y);
            }
        }
    }

    void read_point(uint32_t word) {
        if (awaited_ > 0) {
            read_pattern(word);
            return;
        }
        const Vector2 to{static_cast<double>(word & COORDINATE_MASK),
                         static_cast<double>(word >> COORDINATE_BITS & COORDINATE_MASK)};
        const bool moves = (word & MOVE) != 0;
        if (!is_line_) {
            if (!moves)
                add_crossing(to);
        } else if (!style_.is(STYLE_JOINED)) {
            add_capsule(measured(moves ? to : from_), measured(to));
        } else if (moves) {
            const bool is_patterned = style_.is(STYLE_PATTERN);
            awaited_ = is_patterned ? (is_tangent_ ? 2 : 1) : 0;
            has_incoming_ = has_incoming_ && is_patterned && to.x == from_.x && to.y == from_.y;
        } else {
            add_joined_edge(to);
        }
        from_ = to;
    }

    // A slant, of strokes that follow the ground, and then a phase.
    void read_pattern(uint32_t word) {
        if (awaited_-- == 2) {
            float slant = 1.0F;
            std::memcpy(&slant, &word, sizeof slant);
            slant_ = slant;
            return;
        }
        has_incoming_ = has_incoming_ && (word & PHASE_LIFTS) == 0;
        periods_ = static_cast<double>(word & (PHASE_ONE - 1)) / PHASE_ONE;
    }

    Vector2 at(size_t point) const { return {double{at_x_[point]}, double{at_y_[point]}}; }

    // As the group's lengths are measured: vectors, and so the places that they lead to.
    Vector2 measured(Vector2 v) const { return is_tangent_ ? slope_.tangent(v) : v; }

    void cover(size_t point, double share, double width) {
        if (share <= width)
            shares_[point] = std::min(shares_[point], static_cast<Real>(share));
    }

    // Those rows of points that may lie from y to y, in the group's coordinates.
    PointRange points_between(Real low, Real high) const {
        if (cell_.side == 1 || is_tangent_)
            return {0, shares_.size()};
        const Real rows = static_cast<Real>(cell_.side);
        const Real per_quantum = rows / (static_cast<Real>(cell_quanta(cell_.level)) * unit_);
        const Real first = std::clamp((low - bias_) * per_quantum, Real(0), rows);
        const Real last = std::clamp((high - bias_) * per_quantum + 1, Real(0), rows);
        return {static_cast<size_t>(first) * cell_.side, static_cast<size_t>(last) * cell_.side};
    }

    void add_capsule(Vector2 from, Vector2 to) {
        const auto x0 = static_cast<Real>(from.x), y0 = static_cast<Real>(from.y);
        const auto dx = static_cast<Real>(to.x - from.x), dy = static_cast<Real>(to.y - from.y);
        const auto radius = static_cast<Real>(style_.half_width());
        const Real per_length2 = 1 / std::max(dx * dx + dy * dy, Real(1e-6)), radius2 = radius * radius;
        const bool has_bands = style_.is(STYLE_BANDS);
        const PointRange near =
            points_between(std::min(y0, y0 + dy) - radius, std::max(y0, y0 + dy) + radius);
        met_ = {std::min(met_.first, near.first), std::max(met_.last, near.last)};
        for (size_t i = near.first; i < near.last; ++i) {
            const Real px = at_x_[i] - x0, py = at_y_[i] - y0;
            const Real t = std::clamp((px * dx + py * dy) * per_length2, Real(0), Real(1));
            const Real ex = px - t * dx, ey = py - t * dy, apart2 = ex * ex + ey * ey;
            const Real share = has_bands ? std::sqrt(apart2) / radius : Real(0);
            shares_[i] = apart2 <= radius2 ? std::min(shares_[i], share) : shares_[i];
        }
    }

    void add_joined_edge(Vector2 to) {
        const Vector2 on_map = to - from_, along = measured(on_map), from = measured(from_);
        const double length = std::sqrt(dot(along, along)), width = style_.width_at(periods_);
        const Vector2 direction = length > 0.0 ? Vector2{along.x / length, along.y / length} : Vector2{};
        const double periods = slant_ * std::sqrt(dot(on_map, on_map)) * style_.periods_per_unit();
        for (size_t i = 0; i < shares_.size(); ++i) {
            const Vector2 past = at(i) - from;
            if (length == 0.0) {
                cover(i, style_.dot_share(past), width);
                continue;
            }
            const double t = dot(past, direction);
            if (t >= 0.0 && t <= length)
                cover(i, std::abs(cross(past, direction)) / style_.half_width(),
                      style_.width_at(periods_ + t / length * periods));
            if (has_incoming_)
                cover(i, style_.corner_share(past, incoming_, direction), width);
        }
        if (length == 0.0)
            return;
        has_incoming_ = true;
        incoming_ = direction;
        periods_ += periods;
    }

    // ring_cells.h
    void add_crossing(Vector2 to) {
        const double left = static_cast<double>(bias_);
        const bool starts_left = from_.x == left, ends_left = to.x == left;
        const auto border = static_cast<Real>(starts_left == ends_left ? 1e9 : starts_left ? from_.y : to.y);
        const bool rises = from_.y <= to.y;
        const auto low_x = static_cast<Real>(rises ? from_.x : to.x),
                   low_y = static_cast<Real>(rises ? from_.y : to.y);
        const auto dx = static_cast<Real>(rises ? to.x - from_.x : from_.x - to.x);
        const auto dy = static_cast<Real>(rises ? to.y - from_.y : from_.y - to.y);
        for (size_t i = 0; i < shares_.size(); ++i) {
            const Real px = at_x_[i] - low_x, py = at_y_[i] - low_y;
            const bool on_row = py >= 0 && py < dy && px * dy >= py * dx;
            shares_[i] = on_row != (at_y_[i] >= border) ? none_ - shares_[i] : shares_[i];
        }
    }

    template <typename OnGroup>
    void end_group(OnGroup on_group) {
        if (is_clip_) {
            for (size_t i = 0; i < shares_.size(); ++i)
                open_[i] = shares_[i] <= 1;
        } else {
            const bool hatched = !is_line_ && style_.is(STYLE_HATCH);
            for (size_t i = met_.first; i < met_.last; ++i)
                if ((follows_clip_ && !open_[i]) || (hatched && !is_hatched(i)))
                    shares_[i] = none_;
            on_group(slot_, style_, shares_, met_);
        }
        follows_clip_ = is_clip_;
        if (met_.first < met_.last)
            std::fill(shares_.begin() + static_cast<std::ptrdiff_t>(met_.first),
                      shares_.begin() + static_cast<std::ptrdiff_t>(met_.last), none_);
    }

    bool is_hatched(size_t point) const {
        return style_.hatch_covers(
            cell_.bucket_column, cell_.bucket_row,
            {cell_.corner.x + double{cell_.x[point]}, cell_.corner.y + double{cell_.y[point]}});
    }

    static constexpr Real none_ = static_cast<Real>(not_covered);
    const PreparedDecals& decals_;
    const CellPoints<Real>& cell_;
    Slope slope_;
    Real bias_;
    Real unit_ = 0;
    bool is_tangent_ = false;
    std::vector<Real> at_x_, at_y_;  // the points, in the group's coordinates, as it measures them
    std::vector<Real> shares_;
    PointRange met_;          // those that the group may cover
    std::vector<char> open_;  // not cut off by the clip before
    uint32_t slot_ = 0;
    bool is_line_ = false, is_clip_ = false, follows_clip_ = false;
    bool has_incoming_ = false;
    int awaited_ = 0;  // words of the pattern, after a MOVE
    StyleReader style_;
    Vector2 from_{}, incoming_{};
    double periods_ = 0.0;
    double slant_ = 1.0;  // of lengths along the pattern
};

}  // namespace decalgl

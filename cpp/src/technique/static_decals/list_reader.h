// Reads the list of a cell for some points in it at once: the walk of point.glsl on the CPU, in double precision and to
// the end.
#pragma once

#include <vector>

#include "technique/static_decals/style_reader.h"

namespace decalgl {

// A cell, and points in quanta from its corner.
struct CellPoints {
    int level = 0;
    int64_t bucket_column = 0, bucket_row = 0;
    PlanePoint corner{};  // of the cell, in quanta from that of its bucket
    std::vector<PlanePoint> points;
};

class ListReader {
public:
    ListReader(const PreparedDecals& decals, const CellPoints& cell)
        : decals_(decals),
          cell_(cell),
          bias_(cell_bias(cell.level)),
          at_(cell.points.size()),
          shares_(cell.points.size()),
          open_(cell.points.size()) {}

    // Calls on_group(slot, shares) for the decals of a list, topmost first. A share is that of the half width at which
    // the stroke covers the point, 0 where a fill does, and above 1 where nothing does.
    template <typename OnGroup>
    void read(Span<const uint32_t> words, OnGroup on_group) {
        std::fill(open_.begin(), open_.end(), true);
        bool begun = false;
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
        has_came_ = awaits_phase_ = false;
        std::fill(shares_.begin(), shares_.end(), (header & COVERS) != 0 ? 0.0 : not_covered);
        const double unit = is_line_ ? std::ldexp(1.0, -style_.scale()) : 1.0;
        for (size_t i = 0; i < at_.size(); ++i)
            at_[i] = {cell_.points[i].x * unit + bias_, cell_.points[i].y * unit + bias_};
    }

    void read_point(uint32_t word) {
        if (awaits_phase_) {
            periods_ = static_cast<double>(word) / PHASE_ONE;
            awaits_phase_ = false;
            return;
        }
        const PlanePoint to{static_cast<double>(word & COORDINATE_MASK),
                            static_cast<double>(word >> COORDINATE_BITS & COORDINATE_MASK)};
        const bool moves = (word & MOVE) != 0;
        if (!is_line_) {
            if (!moves)
                add_crossing(to);
        } else if (!style_.is(STYLE_JOINED)) {
            add_capsule(moves ? to : from_, to);
        } else if (moves) {
            has_came_ = has_came_ && to.x == from_.x && to.y == from_.y;
            awaits_phase_ = style_.is(STYLE_PATTERN);
        } else {
            add_joined_edge(to);
        }
        from_ = to;
    }

    void cover(size_t point, double share, double width) {
        if (share <= width)
            shares_[point] = std::min(shares_[point], share);
    }

    void add_capsule(PlanePoint from, PlanePoint to) {
        const PlanePoint along = to - from;
        const double length2 = dot(along, along);
        for (size_t i = 0; i < at_.size(); ++i) {
            const PlanePoint past = at_[i] - from;
            const double t = length2 > 0.0 ? std::clamp(dot(past, along) / length2, 0.0, 1.0) : 0.0;
            const PlanePoint apart{past.x - t * along.x, past.y - t * along.y};
            cover(i, std::sqrt(dot(apart, apart)) / style_.half_width(), 1.0);
        }
    }

    void add_joined_edge(PlanePoint to) {
        const PlanePoint along = to - from_;
        const double length = std::sqrt(dot(along, along)), width = style_.width_at(periods_);
        for (size_t i = 0; i < at_.size(); ++i) {
            const PlanePoint past = at_[i] - from_;
            if (length == 0.0) {
                cover(i, std::sqrt(dot(past, past)) / style_.half_width(), width);
                continue;
            }
            const double t = dot(past, along) / length;
            if (t >= 0.0 && t <= length)
                cover(i, std::abs(cross(past, along)) / length / style_.half_width(),
                      style_.width_at(periods_ + t * style_.periods_per_unit()));
            if (has_came_)
                cover(i, style_.corner_share(past, came_, along), width);
        }
        if (length == 0.0)
            return;
        has_came_ = true;
        came_ = along;
        periods_ += length * style_.periods_per_unit();
    }

    // ring_cells.h
    void add_crossing(PlanePoint to) {
        const bool starts_left = from_.x == bias_, ends_left = to.x == bias_;
        const double border = starts_left == ends_left ? 1e9 : starts_left ? from_.y : to.y;
        const PlanePoint low = from_.y <= to.y ? from_ : to, high = from_.y <= to.y ? to : from_;
        for (size_t i = 0; i < at_.size(); ++i) {
            const bool on_row =
                low.y <= at_[i].y && at_[i].y < high.y && cross(high - low, at_[i] - low) <= 0.0;
            if (on_row != (at_[i].y >= border))
                shares_[i] = not_covered - shares_[i];
        }
    }

    template <typename OnGroup>
    void end_group(OnGroup on_group) {
        if (is_clip_) {
            for (size_t i = 0; i < at_.size(); ++i)
                open_[i] = shares_[i] <= 1.0;
            return;
        }
        const bool hatched = !is_line_ && style_.is(STYLE_HATCH);
        for (size_t i = 0; i < at_.size(); ++i) {
            const PlanePoint inside{cell_.corner.x + cell_.points[i].x, cell_.corner.y + cell_.points[i].y};
            if (!open_[i] || (hatched && !style_.hatch_covers(cell_.bucket_column, cell_.bucket_row, inside)))
                shares_[i] = not_covered;
            open_[i] = true;
        }
        on_group(slot_, style_, shares_);
    }

    const PreparedDecals& decals_;
    const CellPoints& cell_;
    double bias_;
    std::vector<PlanePoint> at_;  // the points, in the group's coordinates
    std::vector<double> shares_;
    std::vector<char> open_;  // not cut off by the clip before
    uint32_t slot_ = 0;
    bool is_line_ = false, is_clip_ = false, has_came_ = false, awaits_phase_ = false;
    StyleReader style_;
    PlanePoint from_{}, came_{};
    double periods_ = 0.0;
};

}  // namespace decalgl

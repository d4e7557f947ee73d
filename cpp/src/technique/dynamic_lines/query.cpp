// What lies at a place: the meaning of widths in pixels (screen_plane.glsl) in double precision.
#include <algorithm>
#include <array>
#include <cmath>

#include "decalgl/terrain/heightfield.h"
#include "technique/dynamic_lines/prepared_lines.h"
#include "vector/stroke_reach.h"

namespace decalgl {
namespace {

constexpr double nearest_share = 1e-3;  // of the point's depth: what lies nearer to the eye is cut off

double half_width_of(const LineStyle& style, double pixels_per_metre) {
    const double unit = (style.kind & IN_METRES) != 0 ? pixels_per_metre : 1.0;
    const double own = static_cast<double>(style.half_width) * unit;
    const auto limit = [&](float pixels, float metres, bool least) {
        const double in_pixels = static_cast<double>(pixels);
        const double on_ground = static_cast<double>(metres) * pixels_per_metre;
        return least ? std::max(in_pixels, on_ground) : std::min(in_pixels, on_ground);
    };
    return std::min(std::max(own, limit(style.least_px, style.least_metres, true)),
                    limit(style.most_px, style.most_metres, false)) +
           static_cast<double>(style.margin) * unit;
}

Vector2 unit(Vector2 way) {
    const double across = length(way);
    return across > 0.0 ? Vector2{way.x / across, way.y / across} : Vector2{1.0, 0.0};
}

Vector2 between(Vector2 a, Vector2 b, double share) {
    return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)};
}

struct ScreenSegment {
    Vector2 from;
    Vector2 to;
    bool seen = false;
    std::array<double, 2> depths{1.0, 1.0};
    std::array<double, 2> shares{0.0, 1.0};  // of the way on the map

    // The share of the way on the map where it is so much of that on the screen.
    double on_map(double share) const {
        const double depth = std::max(depths[1] + share * (depths[0] - depths[1]), 1e-6 * depths[1]);
        return shares[0] + (shares[1] - shares[0]) * share * depths[0] / depth;
    }
};

double foot_share(const ScreenSegment& seen) {
    const Vector2 way{seen.to.x - seen.from.x, seen.to.y - seen.from.y};
    return -dot(seen.from, way) / std::max(dot(way, way), 1e-24);
}

// Of offsets on the map.
ScreenSegment on_screen(const SeenPoint& point, Vector2 a, Vector2 b) {
    const auto depth = [&](Vector2 at) { return 1.0 + at.x * point.lean_x + at.y * point.lean_y; };
    ScreenSegment segment;
    if (depth(a) < nearest_share && depth(b) < nearest_share)
        return segment;
    const double cut = (nearest_share - depth(a)) / (depth(b) - depth(a));
    segment.seen = true;
    segment.shares = {depth(a) < nearest_share ? cut : 0.0, depth(b) < nearest_share ? cut : 1.0};
    const auto project = [&](size_t end) {
        const Vector2 at = between(a, b, segment.shares[end]);
        segment.depths[end] = std::max(depth(at), nearest_share);
        return Vector2{(at.x * point.east[0] + at.y * point.north[0]) / segment.depths[end],
                       (at.x * point.east[1] + at.y * point.north[1]) / segment.depths[end]};
    };
    segment.from = project(0);
    segment.to = project(1);
    return segment;
}

// One slot's lines at one point.
class SlotQuery {
public:
    SlotQuery(const PreparedLines& lines, Span<const LineRecord> own, const SeenPoint& point)
        : lines_(lines),
          own_(own),
          point_(point),
          style_(lines.styles[own[0].slot]),
          half_width_(half_width_of(style_, point.pixels_per_metre)) {}

    bool is_hit() const {
        if (style_.color >> 24 == 0 || !(half_width_ > 0.0) || !is_covered(static_cast<double>(style_.reach)))
            return false;
        // What lies farther in is another band's.
        const bool has_inner = (style_.kind >> BAND_SHIFT & BAND_MASK) != 0;
        if (has_inner && is_covered(static_cast<double>(lines_.styles[own_[0].slot + 1].reach)))
            return false;
        const uint32_t sides = style_.kind & (INSIDE_ONLY | OUTSIDE_ONLY);
        return sides == 0 || is_inside() == (sides == INSIDE_ONLY);
    }

private:
    Vector2 offset(const LineRecord& line, uint32_t vertex) const {
        const ivec2 place = lines_.vertices[line.first + vertex].place;
        return {lines_.lattice.x_of(place) - point_.x, lines_.lattice.y_of(place) - point_.y};
    }

    // Of all rings, by the even-odd rule.
    bool is_inside() const {
        bool inside = false;
        for (const LineRecord& ring : own_) {
            for (uint32_t i = 0; i + 1 < ring.count; ++i) {
                const Vector2 a = offset(ring, i), b = offset(ring, i + 1);
                if ((a.y > 0.0) != (b.y > 0.0) && a.x - a.y * (b.x - a.x) / (b.y - a.y) > 0.0)
                    inside = !inside;
            }
        }
        return inside;
    }

    bool is_covered(double reach) const {
        for (const LineRecord& line : own_)
            for (uint32_t i = 0; i + 1 < line.count; ++i)
                if (covers(line, i, reach))
                    return true;
        return false;
    }

    // Of unit vectors.
    static bool turns(Vector2 before, Vector2 after) {
        constexpr double least_turn = 0.01;  // sine
        return dot(before, after) <= 0.0 || std::abs(before.x * after.y - before.y * after.x) > least_turn;
    }

    // On the map; of a closed line from its last segment to its first one, too.
    Vector2 way(const LineRecord& line, uint32_t segment) const {
        const uint32_t from = segment % (line.count - 1);
        const Vector2 a = offset(line, from), b = offset(line, from + 1);
        return unit({b.x - a.x, b.y - a.y});
    }

    bool covers(const LineRecord& line, uint32_t segment, double reach) const {
        const Vector2 a = offset(line, segment), b = offset(line, segment + 1);
        const ScreenSegment seen = on_screen(point_, a, b);
        if (!seen.seen)
            return false;
        const bool closed = (line.flags & LINE_CLOSED) != 0;
        const bool begins = segment == 0 && !closed, ends = segment + 2 == line.count && !closed;
        // Beyond an end, a neighbour comes nearer or the corner at its end does.
        const double share = foot_share(seen);
        if ((share < 0.0 && !begins) || !is_on_ground(seen, a, b))
            return false;
        const auto corner = static_cast<Corner>(style_.kind & CORNER_MASK);
        const auto cap = static_cast<Cap>(style_.kind >> CAP_SHIFT & 3U);
        const Vector2 direction = unit({seen.to.x - seen.from.x, seen.to.y - seen.from.y});
        const double square = cap == Cap::square ? half_width_ : 0.0, overlap = 1e-3 * half_width_;
        const Vector2 from_a{-seen.from.x, -seen.from.y}, from_b{-seen.to.x, -seen.to.y};
        const double bar =
            bar_reach(from_a, from_b, direction, {begins ? square : overlap, ends ? square : overlap});
        // A round corner reaches beyond a flat end that is near, but a place where the line was cut does not.
        const bool turned = !begins && turns(way(line, segment + line.count - 2), way(line, segment));
        const double at_a = begins                              ? cap_reach(cap, from_a)
                            : turned && corner == Corner::round ? length(from_a)
                                                                : out_of_reach;
        const Vector2 next = ends ? direction : outgoing(line, segment + 1, b);
        if (share > 1.0 && !ends && dot(from_b, next) > 0.0)
            return false;
        const bool goes_on =
            ends || dot(from_b, direction) >= 0.0 || turns(way(line, segment), way(line, segment + 1));
        const double at_b = ends ? cap_reach(cap, from_b)
                            : goes_on
                                ? corner_reach(corner, from_b, direction, next, std::cos(miter_limit(style_)))
                                : out_of_reach;
        const double half_width = reach * half_width_;
        if (style_.pattern == NO_PATTERN)
            return std::min(bar, std::min(at_a, at_b)) <= half_width;
        const Marks marks = marks_along(line, segment, length({b.x - a.x, b.y - a.y}), seen.on_map(share));
        const auto within = [&](double gauge, double mark) {
            return gauge <= std::min(half_width, half_width_ * mark);
        };
        const bool before = begins && dot(from_a, direction) <= 0.0;
        const bool after = dot(from_b, direction) >= 0.0 && (ends || dot(from_b, next) <= 0.0);
        return within(bar, marks.at_foot) || (before && within(at_a, marks.at_from)) ||
               (after && within(at_b, marks.at_to));
    }

    // Whether the ground under the segment is seen where the plane has it.
    bool is_on_ground(const ScreenSegment& seen, Vector2 a, Vector2 b) const {
        const double share = std::clamp(foot_share(seen), 0.0, 1.0);
        const Vector2 foot = between(a, b, seen.on_map(share)), on_plane = between(seen.from, seen.to, share);
        if (point_.terrain == nullptr)
            return true;
        const double rise = point_.terrain->height_at(point_.x + foot.x, point_.y + foot.y) - point_.height -
                            foot.x * point_.gradient_x - foot.y * point_.gradient_y;
        const double depth = std::max(
            1.0 + foot.x * point_.lean_x + foot.y * point_.lean_y + rise * point_.lean_up, nearest_share);
        const auto at = [&](size_t i) {
            return (foot.x * point_.east[i] + foot.y * point_.north[i] + rise * point_.up[i]) / depth;
        };
        const double off = length({at(0) - on_plane.x, at(1) - on_plane.y});
        return !(off > 0.5 * std::max(half_width_, 1.0) + ground_slack +
                           point_.terrain_error);  // in holes there is no height
    }

    // The shares of the width that the pattern leaves; below 0 between marks.
    struct Marks {
        double at_foot, at_from, at_to;
    };

    Marks marks_along(const LineRecord& line, uint32_t segment, double across, double share) const {
        const PatternTexel& head = lines_.patterns[style_.pattern];
        const SourceVertex& from = lines_.vertices[line.first + segment];
        const SourceVertex& to = lines_.vertices[line.first + segment + 1];
        const int octave = std::clamp(static_cast<int>(std::floor(std::log2(point_.pixels_per_metre) + 0.5)) -
                                          first_octave(lines_.lattice),
                                      0, PATTERN_OCTAVES);
        const double scale = head[2] > 0.5F ? 1.0 : std::exp2(octave);
        const double turned = static_cast<uint32_t>(to.arc - from.arc) / 4294967296.0;
        const double turns = std::round(across / static_cast<double>(head[3]) - turned) + turned;
        const double begin = from.arc / 4294967296.0 * scale + static_cast<double>(head[1]);
        const auto width = [&](double phase) {
            double widest = -1.0;
            for (size_t i = 1; i <= static_cast<size_t>(head[0]); ++i) {
                const PatternTexel& mark = lines_.patterns[style_.pattern + i];
                widest = std::max(
                    widest, mark_width({double{mark[0]}, double{mark[1]}, double{mark[2]}, double{mark[3]}},
                                       pattern_phase(phase, 1.0)));
            }
            return widest;
        };
        return {width(begin + share * turns * scale), width(begin), width(begin + turns * scale)};
    }

    // The direction on the screen in which the line goes on.
    Vector2 outgoing(const LineRecord& line, uint32_t vertex, Vector2 from) const {
        const uint32_t next = vertex + 1 < line.count ? vertex + 1 : 1;
        const ScreenSegment seen = on_screen(point_, from, offset(line, next));
        return unit({seen.to.x - seen.from.x, seen.to.y - seen.from.y});
    }

    static double miter_limit(const LineStyle& style) {
        constexpr double radians = 3.14159265358979323846 / 180.0;
        return (style.kind >> MITER_SHIFT) / 256.0 * radians;
    }

    const PreparedLines& lines_;
    Span<const LineRecord> own_;
    const SeenPoint& point_;
    const LineStyle& style_;
    double half_width_;  // of the whole line, pixels
};

}  // namespace

std::vector<FeatureReference> PreparedLines::query(const SeenPoint& point) const {
    std::vector<FeatureReference> found;
    // Lines stand in draw order; a feature may show more than one of its decals.
    size_t end = lines.size();
    while (end > 0) {
        size_t first = end - 1;
        while (first > 0 && lines[first - 1].slot == lines[end - 1].slot)
            --first;
        const SlotQuery query(*this, lines.span().subspan(first, end - first), point);
        const FeatureReference feature = slots[lines[first].slot].feature;
        if (query.is_hit() && std::find(found.begin(), found.end(), feature) == found.end())
            found.push_back(feature);
        end = first;
    }
    return found;
}

}  // namespace decalgl

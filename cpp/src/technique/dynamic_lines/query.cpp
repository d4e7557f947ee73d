// What lies at a place: the meaning of widths in pixels (screen_plane.glsl) in double precision.
#include <algorithm>
#include <cmath>

#include "technique/dynamic_lines/prepared_lines.h"
#include "vector/stroke_reach.h"

namespace decalgl {
namespace {

constexpr double nearest_share = 1e-3;  // of the point's depth: what lies nearer to the eye is cut off

double half_width_of(const LineStyle& style, double pixels_per_metre) {
    const double own =
        static_cast<double>(style.half_width) * ((style.kind & IN_METRES) != 0 ? pixels_per_metre : 1.0);
    const auto limit = [&](float pixels, float metres, bool least) {
        const double in_pixels = static_cast<double>(pixels);
        const double on_ground = static_cast<double>(metres) * pixels_per_metre;
        return least ? std::max(in_pixels, on_ground) : std::min(in_pixels, on_ground);
    };
    return std::min(std::max(own, limit(style.least_px, style.least_metres, true)),
                    limit(style.most_px, style.most_metres, false));
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
    bool seen;
};

// Of offsets on the map.
ScreenSegment on_screen(const SeenPoint& point, Vector2 a, Vector2 b) {
    const auto depth = [&](Vector2 at) { return 1.0 + at.x * point.lean_x + at.y * point.lean_y; };
    if (depth(a) < nearest_share && depth(b) < nearest_share)
        return {a, b, false};
    const double share = (nearest_share - depth(a)) / (depth(b) - depth(a));
    const Vector2 cut = between(a, b, share);
    const auto project = [&](Vector2 at) {
        const Vector2 seen = depth(at) < nearest_share ? cut : at;
        const double by = std::max(depth(seen), nearest_share);
        return Vector2{(seen.x * point.east[0] + seen.y * point.north[0]) / by,
                       (seen.x * point.east[1] + seen.y * point.north[1]) / by};
    };
    return {project(a), project(b), true};
}

class LineQuery {
public:
    LineQuery(const PreparedLines& lines, const SeenPoint& point) : lines_(lines), point_(point) {}

    bool covers(const LineRecord& line) const {
        const LineStyle& style = lines_.styles[line.slot];
        const double half_width = half_width_of(style, point_.pixels_per_metre);
        if (style.color >> 24 == 0 || !(half_width > 0.0))
            return false;
        for (uint32_t i = 0; i + 1 < line.count; ++i)
            if (covers(line, i, style, half_width))
                return true;
        return false;
    }

private:
    Vector2 offset(const LineRecord& line, uint32_t vertex) const {
        const ivec2 place = lines_.vertices[line.first + vertex].place;
        return {lines_.lattice.x_of(place) - point_.x, lines_.lattice.y_of(place) - point_.y};
    }

    bool covers(const LineRecord& line, uint32_t segment, const LineStyle& style, double half_width) const {
        const Vector2 a = offset(line, segment), b = offset(line, segment + 1);
        const ScreenSegment seen = on_screen(point_, a, b);
        if (!seen.seen)
            return false;
        const bool closed = (line.flags & LINE_CLOSED) != 0;
        const bool begins = segment == 0 && !closed, ends = segment + 2 == line.count && !closed;
        const auto corner = static_cast<Corner>(style.kind & CORNER_MASK);
        const auto cap = static_cast<Cap>(style.kind >> CAP_SHIFT & 3U);
        const Vector2 direction = unit({seen.to.x - seen.from.x, seen.to.y - seen.from.y});
        const double square = cap == Cap::square ? half_width : 0.0, overlap = 1e-3 * half_width;
        const Vector2 from_a{-seen.from.x, -seen.from.y}, from_b{-seen.to.x, -seen.to.y};
        double reach =
            bar_reach(from_a, from_b, direction, {begins ? square : overlap, ends ? square : overlap});
        if (begins)
            reach = std::min(reach, cap_reach(cap, from_a));
        if (ends)
            reach = std::min(reach, cap_reach(cap, from_b));
        if (!begins && corner == Corner::round)
            reach = std::min(reach, length(from_a));
        if (!ends)
            reach = std::min(reach, corner_reach(corner, from_b, direction, outgoing(line, segment + 1, b),
                                                 std::cos(miter_limit(style))));
        return reach <= half_width;
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
    const SeenPoint& point_;
};

}  // namespace

std::vector<FeatureReference> PreparedLines::query(const SeenPoint& point) const {
    std::vector<FeatureReference> found;
    const LineQuery query(*this, point);
    // Lines stand in draw order; a feature may show more than one of its decals.
    for (size_t i = lines.size(); i-- > 0;) {
        const FeatureReference feature = slots[lines[i].slot].feature;
        if (query.covers(lines[i]) && std::find(found.begin(), found.end(), feature) == found.end())
            found.push_back(feature);
    }
    return found;
}

}  // namespace decalgl

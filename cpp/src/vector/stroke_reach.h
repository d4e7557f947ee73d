// How near a point is to the parts of a stroke: shaders/shared/stroke.glsl in double precision.
//
// Each function answers with the half width from which on its part covers the point, or with out_of_reach.
#pragma once

#include <algorithm>
#include <cmath>

#include "decalgl/vector/stroke.h"

namespace decalgl {

struct Vector2 {
    double x = 0.0;
    double y = 0.0;
};

inline double dot(Vector2 a, Vector2 b) {
    return a.x * b.x + a.y * b.y;
}
inline double cross(Vector2 a, Vector2 b) {
    return a.x * b.y - a.y * b.x;
}
inline double length(Vector2 a) {
    return std::hypot(a.x, a.y);
}

constexpr double out_of_reach = 1e300;

// Between a segment's ends, from which `from_a` and `from_b` lead, and so much farther beyond them.
inline double bar_reach(Vector2 from_a, Vector2 from_b, Vector2 direction, Vector2 longer) {
    const bool between = dot(from_a, direction) >= -longer.x && dot(from_b, direction) <= longer.y;
    return between ? std::abs(cross(direction, from_a)) : out_of_reach;
}

// `limit`: the cosine of the miter limit.
inline double corner_reach(Corner corner, Vector2 from, Vector2 incoming, Vector2 outgoing, double limit) {
    const Vector2 sum{incoming.x + outgoing.x, incoming.y + outgoing.y};
    const bool sharp = dot(incoming, outgoing) < -limit - 1e-6 || dot(sum, sum) <= 1e-12;
    if (corner == Corner::round || (corner == Corner::miter && sharp))
        return length(from);
    if (dot(from, incoming) < 0.0 || dot(from, outgoing) > 0.0)
        return out_of_reach;
    const double reach = std::max(std::abs(cross(incoming, from)), std::abs(cross(outgoing, from)));
    if (corner == Corner::miter)
        return reach;
    const double sine = std::abs(cross(incoming, outgoing));
    const Vector2 bend{incoming.x - outgoing.x, incoming.y - outgoing.y};
    return sine < 1e-7 ? out_of_reach : std::max(reach, dot(from, bend) / sine);
}

// Beside what the bar does.
inline double cap_reach(Cap cap, Vector2 from) {
    return cap == Cap::round ? length(from) : out_of_reach;
}

// A part of one point.
inline double dot_reach(Cap cap, Vector2 from) {
    if (cap == Cap::round)
        return length(from);
    return cap == Cap::square ? std::max(std::abs(from.x), std::abs(from.y)) : out_of_reach;
}

// Where a length along a stroke lies in its pattern.
inline double pattern_phase(double along, double period) {
    return along - period * std::floor(along / period);
}

// The share of a stroke's width that a mark has at a phase; below 0 beside the mark.
inline double mark_width(const PatternMark& mark, double phase) {
    if (phase < mark.begin || phase > mark.end)
        return -1.0;
    const double share = (phase - mark.begin) / (mark.end - mark.begin);
    return mark.begin_width + share * (mark.end_width - mark.begin_width);
}

}  // namespace decalgl

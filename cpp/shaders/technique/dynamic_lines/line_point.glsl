// Whether a line's part covers a point: the one in the middle of all coordinates here, in pixels or in metres.
//
// Corners are told from both segments that meet there, since either one's box may be all that holds the point.
//
// JOINED   corners and caps that are not round
#include "shared/stroke.glsl"
#include "technique/dynamic_lines/line_styles.h"

struct LinePart {
    vec2 from;
    vec2 to;
    vec2 incoming;  // unit vectors of the segments before and after
    vec2 outgoing;
    bool begins;
    bool ends;
};

vec2 unit_vector(vec2 way) {
    float across = length(way);
    return across > 1e-9 ? way / across : vec2(1.0, 0.0);
}

float distance_to_part(LinePart part) {
    vec2 way = part.to - part.from;
    float share = clamp(-dot(part.from, way) / max(dot(way, way), 1e-12), 0.0, 1.0);
    return length(part.from + share * way);
}

bool covers(LinePart part, uint kind, float half_width) {
#ifdef JOINED
    uint corner = kind & CORNER_MASK, cap = kind >> CAP_SHIFT & 3u;
    float limit = cos(radians(float(kind >> MITER_SHIFT) / 256.0));
    vec2 direction = unit_vector(part.to - part.from);
    float overlap = 1e-3 * half_width, longer = cap == square_cap ? half_width : 0.0;
    float across = cross_product(direction, -part.from);
    vec2 beyond = vec2(part.begins ? longer : overlap, part.ends ? longer : overlap);
    float reach = bar_reach(-part.from, -part.to, direction, across, beyond);
    float at_from = part.begins ? cap_reach(cap, -part.from)
                                : corner_reach(corner, -part.from, part.incoming, direction, limit);
    float at_to = part.ends ? cap_reach(cap, -part.to)
                            : corner_reach(corner, -part.to, direction, part.outgoing, limit);
    return min(reach, min(at_from, at_to)) <= half_width;
#else
    return distance_to_part(part) <= half_width;
#endif
}

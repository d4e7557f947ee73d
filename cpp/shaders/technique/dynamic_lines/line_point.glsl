// Whether a line's part covers a point: the one in the middle of all coordinates here, in pixels or in metres.
//
// Corners are told from both segments that meet there, since either one's box may be all that holds the point.
//
// JOINED   corners and caps that are not round
// STYLED   patterns along lines, and colours across
#include "shared/stroke.glsl"
#include "technique/dynamic_lines/line_looks.glsl"

struct LinePart {
    vec2 from;
    vec2 to;
    vec2 incoming;  // unit vectors of the segments before and after
    vec2 outgoing;
    bool begins;
    bool ends;
    bool turned;  // at its beginning, and at its end: else it goes straight on there, as where the line was cut
    bool turns;
    vec3 marks;  // shares of the width that the pattern leaves: at the point's foot and at both ends; below 0: none
};

vec2 unit_vector(vec2 way) {
    float across = length(way);
    return across > 1e-9 ? way / across : vec2(1.0, 0.0);
}

// Of unit vectors.
bool turns(vec2 before, vec2 after) {
    const float least_turn = 0.01;  // sine
    return dot(before, after) <= 0.0 || abs(cross_product(before, after)) > least_turn;
}

float distance_to_part(LinePart part) {
    vec2 way = part.to - part.from;
    float share = clamp(-dot(part.from, way) / max(dot(way, way), 1e-12), 0.0, 1.0);
    return length(part.from + share * way);
}

// Whether the point is this part's to decide, and no neighbour's that comes nearer: a point beside the part, in the gap to the
// next one, or beyond an end of the line. `share`: of the part, where its line comes nearest. So what the ground under the
// nearest point says does not depend on where a line is cut.
bool decides(LinePart part, float share) {
    const float overlap = 1e-3;  // so that rounding opens no gap
    bool before = share < 0.0 && !part.begins;
    bool after = share > 1.0 && !part.ends && dot(part.to, part.outgoing) < -overlap;
    return !before && !after;
}

// `whole`: half the width of all of the line.
bool covers(LinePart part, LineLook look, float whole) {
    float half_width = whole * look.reach;
#ifdef JOINED
    uint corner = corner_of(look.kind), cap = cap_of(look.kind);
    float limit = cos(miter_limit(look.kind));
    vec2 direction = unit_vector(part.to - part.from);
    float overlap = 1e-3 * half_width, longer = cap == square_cap ? whole : 0.0;
    float across = cross_product(direction, -part.from);
    vec2 beyond = vec2(part.begins ? longer : overlap, part.ends ? longer : overlap);
    float reach = bar_reach(-part.from, -part.to, direction, across, beyond);
    float at_from = part.begins ? cap_reach(cap, -part.from)
                                : corner_reach(corner, -part.from, part.incoming, direction, limit);
    float at_to = part.ends ? cap_reach(cap, -part.to)
                            : corner_reach(corner, -part.to, direction, part.outgoing, limit);
    // A round corner reaches beyond a flat end that is near, but a place where the line was cut does not.
    if (!part.begins && !part.turned) at_from = out_of_reach;
    if (!part.ends && !part.turns && dot(part.to, direction) > 0.0) at_to = out_of_reach;
#ifdef STYLED
    if (look.pattern != NO_PATTERN) {
        // Joints fill the gap between bars alone, so that marks end flat.
        bool before = dot(part.from, direction) >= 0.0 && (part.begins || dot(part.from, part.incoming) <= 0.0);
        bool after = dot(part.to, direction) <= 0.0 && (part.ends || dot(part.to, part.outgoing) >= 0.0);
        vec3 widths = min(vec3(half_width), whole * part.marks);
        return reach <= widths.x || (before && at_from <= widths.y) || (after && at_to <= widths.z);
    }
#endif
    return min(reach, min(at_from, at_to)) <= half_width;
#else
    return distance_to_part(part) <= half_width;
#endif
}

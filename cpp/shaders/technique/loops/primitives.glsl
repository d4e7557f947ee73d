// Triangles and edges at one point: sections 4.2 and 4.4 of LOOPS.
#include "technique/loops/detail.glsl"
#include "technique/loops/loops_layout.h"

uniform isamplerBuffer loops_points;
uniform usamplerBuffer loops_bases;
uniform usamplerBuffer loops_activations;
uniform usamplerBuffer loops_styles;  // colour, bits of the half width in quanta

ivec2 place_of(uint point) {
    return texelFetch(loops_points, int(point & LOOPS_POINT_MASK)).rg;
}

bool is_active_point(uint point) {
    return is_active(texelFetch(loops_activations, int(point & LOOPS_POINT_MASK)));
}

#ifdef FILLS
// Whether a side crosses the point's row at or left of it. Exact, so that the crossings of a side that two
// triangles share cancel.
bool crosses(ivec2 a, ivec2 b, ivec2 point) {
    bool upwards = a.y <= b.y;
    ivec2 low = upwards ? a : b, high = upwards ? b : a;
    ivec2 to_point = point - low, along = high - low;
    int high1, low1, high2, low2;
    imulExtended(along.x, to_point.y, high1, low1);
    imulExtended(along.y, to_point.x, high2, low2);
    bool at_or_left = high1 < high2 || (high1 == high2 && uint(low1) <= uint(low2));
    return low.y <= point.y && point.y < high.y && at_or_left;
}

// Whether the triangle of a vertex and its base holds the point. Added and taken away are the same modulo 2, so
// neither that nor the direction of its ring is told.
bool triangle_holds(uint primitive, ivec2 point) {
    uvec2 base = texelFetch(loops_bases, int(primitive)).rg;
    ivec2 a = place_of(base.x), s = place_of(primitive), b = place_of(base.y);
    return (crosses(a, s, point) != crosses(s, b, point)) != crosses(a, b, point);
}
#endif

#ifdef STROKES
// Squared distance from the point to a segment, in quanta; of which the sides are near, in a stroke's own scale.
float distance2(ivec2 a, ivec2 b, ivec2 point) {
    vec2 from_a = vec2(point - a), along = vec2(b - a);
    float length2 = dot(along, along);
    float share = length2 > 0.0 ? clamp(dot(from_a, along) / length2, 0.0, 1.0) : 0.0;
    vec2 away = from_a - share * along;
    return dot(away, away);
}

// What of a primitive is drawn. Figure 7's six rules: nothing of a base that is not there yet; the base where it is
// not split; else those of the other two sides that are edges, since others have triangles of their own.
struct Drawn {
    uint from;  // the base, or the left side
    uint to;
    uint last;  // the end of the right side; no_side: there is none
    bool any;
};
const uint no_side = 0xFFFFFFFFu;

Drawn drawn_of(uint primitive) {
    uint p = primitive & LOOPS_POINT_MASK;
    bool is_edge = (primitive & EDGE_FLAG) != 0u;
    uvec2 base = texelFetch(loops_bases, int(p)).rg;
    uint left = base.x & LOOPS_POINT_MASK;
    uint generator = (base.x & BASE_FROM_RIGHT) != 0u ? base.y : left;
    if (is_edge) generator = (primitive & EDGE_FROM_NEXT) != 0u ? p + 1u : p;
    bool generated = is_active_point(generator);
    bool is_split = !is_edge && is_active_point(p);
#ifdef SEGMENTS
    Drawn drawn = Drawn(left, base.y, no_side, generated && !is_split);
#else
    bool left_drawn = (base.x & BASE_LEFT_EDGE) != 0u, right_drawn = (base.x & BASE_RIGHT_EDGE) != 0u;
    Drawn drawn = Drawn(left, is_split ? p : base.y, is_split && right_drawn ? base.y : no_side,
                        generated && (!is_split || left_drawn || right_drawn));
    // The right side alone.
    if (is_split && !left_drawn) drawn = Drawn(p, base.y, no_side, drawn.any);
#endif
    if (is_edge) drawn = Drawn(p, p + 1u, no_side, generated);
    return drawn;
}

bool stroke_covers(Drawn drawn, float half_width, ivec2 point) {
    ivec2 to = place_of(drawn.to);
    float least = distance2(place_of(drawn.from), to, point);
#ifndef SEGMENTS
    uint last = drawn.last == no_side ? drawn.to : drawn.last;
    least = min(least, distance2(to, place_of(last), point));
#endif
    return least <= half_width * half_width;
}
#endif

// Lines: which of a cell's segments cover a point.
#include "technique/static_bvh/tree.glsl"

uniform usamplerBuffer bvh_segments;
uniform usamplerBuffer bvh_owners;

// Differences up to here leave float32 an eighth of a quantum for the distance.
const int float_reach = 1 << 20;

float exact_distance2(ivec2 point, ivec2 a, ivec2 b) {
    ivec2 along = b - a;
    vec2 from_a = vec2(point - a);
    vec2 from_b = vec2(point - b);
    Wide past_a = wide_dot(point - a, along);
    if (past_a.high < 0 || (past_a.high == 0 && past_a.low == 0u)) return dot(from_a, from_a);
    if (wide_dot(point - b, along).high >= 0) return dot(from_b, from_b);
    float apart = magnitude(wide_cross(point - a, along)) / length(vec2(along));
    return apart * apart;
}

// Squared quanta from a point to a segment.
float distance2(ivec2 point, ivec2 a, ivec2 b) {
    ivec2 reach = max(abs(point - a), abs(b - a));
    if (max(reach.x, reach.y) >= float_reach) return exact_distance2(point, a, b);
    vec2 along = vec2(b - a);
    vec2 from = vec2(point - a);
    float t = clamp(dot(from, along) / max(dot(along, along), 1.0), 0.0, 1.0);
    vec2 apart = from - t * along;
    return dot(apart, apart);
}

// A candidate of the cell: the line that it belongs to, and how far it is from the point, if that is within
// its half width; else infinitely far.
struct Candidate {
    uint slot;
    float distance2;
};

const float out_of_reach = 1e38;

Candidate candidate(int object, ivec2 point) {
    ivec2 ends = ivec2(texelFetch(bvh_segments, object).rg);
    Candidate found;
    found.slot = texelFetch(bvh_owners, ends.x).r;
    float half_width = uintBitsToFloat(texelFetch(bvh_styles, int(found.slot)).g);
    float d2 = distance2(point, texelFetch(bvh_vertices, ends.x).rg, texelFetch(bvh_vertices, ends.y).rg);
    found.distance2 = d2 <= half_width * half_width ? d2 : out_of_reach;
    return found;
}

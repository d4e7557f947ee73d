// Strokes that are round everywhere: which of a cell's segments cover a point.
#include "technique/static_bvh/candidate.glsl"

// Squared quanta from a point to a segment.
float distance2(ivec2 point, ivec2 a, ivec2 b) {
    ivec2 reach = max(abs(point - a), abs(b - a));
    vec2 from = vec2(point - a);
    if (max(reach.x, reach.y) >= float_reach) {
        vec2 from_b = vec2(point - b);
        Wide past_a = wide_dot(point - a, b - a);
        if (past_a.high < 0 || (past_a.high == 0 && past_a.low == 0u)) return dot(from, from);
        if (wide_dot(point - b, b - a).high >= 0) return dot(from_b, from_b);
        float apart = exact_across(point, a, b);
        return apart * apart;
    }
    vec2 along = vec2(b - a);
    float t = clamp(dot(from, along) / max(dot(along, along), 1.0), 0.0, 1.0);
    vec2 apart = from - t * along;
    return dot(apart, apart);
}

Candidate candidate(int segment, ivec2 point) {
    ivec2 ends = ivec2(texelFetch(bvh_segments, segment).rg);
    Candidate found;
    found.slot = texelFetch(bvh_owners, ends.x).r;
    float half_width = uintBitsToFloat(texelFetch(bvh_styles, int(found.slot)).g);
    float d2 = distance2(point, texelFetch(bvh_vertices, ends.x).rg, texelFetch(bvh_vertices, ends.y).rg);
    found.covers = half_width > 0.0 && d2 <= half_width * half_width;
    found.distance2 = d2;
    found.across = 0.0;
    return found;
}

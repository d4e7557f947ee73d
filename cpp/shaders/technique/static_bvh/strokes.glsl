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

#ifdef THOENY
Candidate candidate(int segment, ivec2 point, mat2 foot) {
#else
Candidate candidate(int segment, ivec2 point) {
#endif
    ivec2 ends = ivec2(texelFetch(bvh_segments, segment).rg);
    ivec2 a = texelFetch(bvh_vertices, ends.x).rg, b = texelFetch(bvh_vertices, ends.y).rg;
    Candidate found;
    found.slot = texelFetch(bvh_owners, ends.x).r;
    uvec4 style = texelFetch(bvh_styles, int(found.slot));
    float half_width = uintBitsToFloat(style.g);
    found.rank = style.a;
    found.distance2 = distance2(point, a, b);
#ifdef THOENY
    vec2 along = a == b ? vec2(1.0, 0.0) : normalize(vec2(b - a));
    float coverage = thoeny_coverage(sqrt(found.distance2), half_width, pixel_width(foot, vec2(-along.y, along.x)));
    found.covers = half_width > 0.0 && coverage > 0.0;
    vec4 straight = unpackUnorm4x8(style.r);
    found.color = coverage * vec4(straight.rgb * straight.a, straight.a);
#else
    found.covers = half_width > 0.0 && found.distance2 <= half_width * half_width;
    found.across = 0.0;
#endif
    return found;
}

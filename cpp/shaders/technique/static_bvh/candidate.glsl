// What strokes of any style have in common.
#include "technique/static_bvh/tree.glsl"
#ifdef THOENY
#include "shared/thoeny_coverage.glsl"
#endif

uniform isamplerBuffer bvh_vertices;
uniform usamplerBuffer bvh_segments;
uniform usamplerBuffer bvh_owners;

// Differences up to here leave float32 an eighth of a quantum for the distance.
const int float_reach = 1 << 20;

// From the line through a and b, in quanta.
float exact_across(ivec2 point, ivec2 a, ivec2 b) {
    return magnitude(wide_cross(point - a, b - a)) / length(vec2(b - a));
}

// A segment of the cell: the stroke that it belongs to and its place in draw order, whether it covers the point, the square of the least half
// width at which it would, and the place across the stroke, from 0 to 1. With THOENY, whether it covers any of
// the pixel, and the premultiplied colour of what it covers.
struct Candidate {
    uint slot;
    uint rank;
    bool covers;
    float distance2;
#ifdef THOENY
    vec4 color;
#else
    float across;
#endif
};

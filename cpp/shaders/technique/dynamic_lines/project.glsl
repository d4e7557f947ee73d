// Where segments lie in the picture.
#include "shared/view_block.h"
#include "technique/dynamic_lines/line_vertices.glsl"

uniform ivec2 base_place;
uniform vec2 base_rest;
uniform float quantum;

// Relative to the base.
vec2 map_place(MatchedVertex vertex) {
    return vec2(vertex.place - base_place) * quantum - base_rest;
}

vec3 ground_place(MatchedVertex vertex) {
    return vec3(map_place(vertex), (vertex.height - base_sample_fraction.z) - base_sample_fraction.w);
}

// Pixels from the picture's corner; a segment is cut off where it comes too near to the eye. w: 1, or 0 behind the eye.
struct ProjectedSegment {
    vec2 from;
    vec2 to;
    float nearest;  // depth
    bool seen;
};

ProjectedSegment project(vec3 from, vec3 to) {
    vec4 a = clip_from_base * vec4(from, 1.0), b = clip_from_base * vec4(to, 1.0);
    const float near = 1e-3;
    bool behind_a = a.w < near, behind_b = b.w < near;
    float rise = b.w - a.w;
    vec4 middle = mix(a, b, clamp((near - a.w) / (abs(rise) > 1e-12 ? rise : 1e-12), 0.0, 1.0));
    a = behind_a ? middle : a;
    b = behind_b ? middle : b;
    vec2 at_a = (0.5 * a.xy / max(a.w, near) + 0.5) * spacing.zw, at_b = (0.5 * b.xy / max(b.w, near) + 0.5) * spacing.zw;
    return ProjectedSegment(at_a, at_b, min(dot(from, forward.xyz), dot(to, forward.xyz)), !(behind_a && behind_b));
}

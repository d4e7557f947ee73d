// When a vertex is active: where its error is greater than the least tolerance in its region (activation.h).
//
//               eye                      The region is a disc on the map, from the lowest to the highest ground
//                 \                      in it. What is nearest to the eye, and what is farthest, bounds the
//           ______ \______               tolerance everywhere in it. Regions of parents hold those of their
//          |       ..     | highest      children, so their bounds are no greater, and no child is active alone.
//          |______________| lowest
#include "technique/loops/lists.glsl"

uniform float quantum;        // metres, a power of two
uniform float length_scale;   // metres of a length of 1
uniform float uniform_bound;  // metres
#if defined(SCREEN) || defined(BY_DISTANCE)
uniform ivec2 eye_place;   // quanta, and metres beyond
uniform vec2 eye_rest;
uniform vec2 eye_heights;  // of the lowest ground above the eye; up to the highest
#endif
#ifdef SCREEN
uniform vec4 eye_forward;   // w: its length on the map
uniform vec2 screen_bound;  // metres a metre of depth; anywhere
#endif
#ifdef BY_DISTANCE
const int most_steps = 8;
uniform vec2 detail_steps[most_steps];  // distance, tolerance; the last one is repeated
#endif
#ifdef CIRCLE
uniform ivec2 circle_centre;
uniform vec2 circle_rest;
uniform vec2 circle;  // radius, tolerance
#endif

float tolerance_in(ivec2 proxy, float radius, vec2 heights) {
    float bound = uniform_bound;
#if defined(SCREEN) || defined(BY_DISTANCE)
    vec2 away = vec2(proxy - eye_place) * quantum - eye_rest;
    vec2 levels = eye_heights.x + heights * eye_heights.y;
#endif
#ifdef SCREEN
    // Of what is in the picture, a metre shows as at most 1 / (z cos a) of what it does one metre ahead, at the depth z
    // and the angle a of the picture's corners from its middle.
    vec2 along = eye_forward.z * levels;
    float depth = dot(eye_forward.xy, away) - eye_forward.w * radius + min(along.x, along.y);
    bound = min(bound, screen_bound.x * max(depth, 0.0) + screen_bound.y);
#endif
#ifdef BY_DISTANCE
    float beside = length(away);
    float nearest = length(vec2(max(beside - radius, 0.0), max(0.0, max(levels.x, -levels.y))));
    float stepped = detail_steps[0].y;
    for (int i = 1; i < most_steps; ++i) {
        vec2 from = detail_steps[i - 1], to = detail_steps[i];
        stepped += (to.y - from.y) * clamp((nearest - from.x) / max(to.x - from.x, 1e-30), 0.0, 1.0);
    }
    bound = min(bound, stepped);
#endif
#ifdef CIRCLE
    vec2 from_centre = vec2(proxy - circle_centre) * quantum - circle_rest;
    if (length(from_centre) - radius <= circle.x) bound = min(bound, circle.y);
#endif
    return bound;
}

bool is_active(uvec4 activation) {
    vec2 lengths = unpackHalf2x16(activation.z) * length_scale;
    return lengths.x > tolerance_in(ivec2(activation.xy), lengths.y, unpackUnorm2x16(activation.w));
}

// The segments of a pixel's tile (bins_layout.h), and what a pixel has to know of one.
#include "technique/dynamic_lines/bins_layout.h"
#include "technique/dynamic_lines/line_looks.glsl"
#include "technique/dynamic_lines/screen_plane.glsl"
#include "technique/dynamic_lines/tile_range.glsl"
#ifdef STYLED
#include "technique/dynamic_lines/line_patterns.glsl"
#endif

uniform usamplerBuffer tile_list;
uniform samplerBuffer segment_ends;
uniform usamplerBuffer segment_joints;
#ifdef STYLED
uniform usamplerBuffer segment_arcs;
#endif

const uint no_slot = 0xFFFFFFFFu;

struct Joints {
    vec2 next;  // on the map
    uint slot;
    uint flags;
};

Joints joints_at(int segment) {
    uvec4 texel = texelFetch(segment_joints, segment);
    return Joints(uintBitsToFloat(texel.xy), texel.z, texel.w);
}

vec2 direction_of_segment(ScreenSegment segment) {
    vec2 way = segment.to - segment.from;
    float across = length(way);
    return across > 1e-9 ? way / across : vec2(1.0, 0.0);
}

// One segment as a pixel sees it.
struct SeenSegment {
    ScreenSegment segment;
    vec2 direction;
    vec2 outgoing;  // in which the line goes on from its end
    uint flags;
    bool is_on_ground;
#ifdef SIDES
    bool inside_left;  // of a ring's segment: its polygon lies to the left, as it is seen
#endif
#ifdef STYLED
    Phases phases;
#endif
};

bool begins(SeenSegment seen) {
    return (seen.flags & SEGMENT_BEGINS) != 0u;
}

bool finishes(SeenSegment seen) {
    return (seen.flags & SEGMENT_ENDS) != 0u;
}

SeenSegment seen_segment(ScreenPlane plane, int index, LineLook look, float half_width) {
    vec4 ends = texelFetch(segment_ends, index);
    Joints joints = joints_at(index);
    SeenSegment seen;
    seen.segment = on_screen(plane, ends);
    seen.direction = direction_of_segment(seen.segment);
    seen.outgoing = seen.direction;
#if defined(JOINED) || defined(SIDES) || !defined(COVERAGE)
    seen.outgoing = direction_of_segment(on_screen(plane, vec4(ends.zw, joints.next)));
#endif
    seen.flags = joints.flags;
    seen.is_on_ground = is_on_ground(plane, seen.segment, ends, half_width);
#ifdef SIDES
    seen.inside_left = ((joints.flags & SEGMENT_INSIDE_RIGHT) == 0u) == (determinant(plane.to_screen) > 0.0);
#endif
#ifdef STYLED
    seen.phases = phases_of(look.pattern, texelFetch(segment_arcs, index).rg, plane.pixels_per_metre);
#endif
    return seen;
}

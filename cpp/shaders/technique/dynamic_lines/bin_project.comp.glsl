// Segments as a view has them: relative to its base, and where on the screen they may be seen.
//
// LIMITS   widths that depend on the depth
// STYLED   patterns along lines
// LENS     other looks inside the lens: the wider one counts
#include "technique/dynamic_lines/bins_layout.h"
#include "technique/dynamic_lines/ground_reach.glsl"
#include "technique/dynamic_lines/items.glsl"
#include "technique/dynamic_lines/line_looks.glsl"
#include "technique/dynamic_lines/project.glsl"
#ifdef STYLED
#include "technique/dynamic_lines/segment_arcs.glsl"
#endif

uniform usamplerBuffer line_segments;

layout(std430, binding = 0) readonly buffer Count {
    uint segment_count;
};
layout(std430, binding = 1) writeonly buffer Ends {
    vec4 segment_ends[];
};
layout(std430, binding = 2) writeonly buffer Joints {
    uvec4 segment_joints[];
};
layout(std430, binding = 3) writeonly buffer Spans {
    vec4 segment_spans[];  // on the screen, pixels from the picture's corner
};
layout(std430, binding = 4) writeonly buffer Reaches {
    float segment_reaches[];  // pixels; below 0: nowhere
};

#ifdef STYLED
layout(std430, binding = 5) writeonly buffer Arcs {
    uvec2 segment_arcs[];
};
#endif

const float least_turn = 0.01;      // sine
const float half_diagonal = 0.7072;  // of a pixel, whose samples lie off its centre

bool turns(vec2 before, vec2 after) {
    float across = before.x * after.y - before.y * after.x;
    return dot(before, after) <= 0.0 || abs(across) > least_turn * length(before) * length(after);
}

// How far from a segment its line, with corners and caps, may be seen; 0 where it is not shown.
float shown_reach(uint slot, float pixels_per_metre) {
    LineLook look = look_of(slot);
    float width = takes_room(look) ? half_width_in_pixels(look, slot, pixels_per_metre) : 0.0;
    float reach = width + ground_reach(width) + half_diagonal;
#ifdef JOINED
    reach += (joint_reach(look.kind) - 1.0) * width;
#endif
    if (width <= 0.0) reach = 0.0;
    return reach;
}

void main() {
    uint index = this_item();
    if (index >= item_count) return;
    bool there = index < segment_count;
    uvec4 segment = texelFetch(line_segments, int(there ? index : 0u));
    MatchedVertex from = vertex_at(segment.y), to = vertex_at(segment.z);
    bool begins = segment.x == NO_VERTEX, ends = segment.w == NO_VERTEX;
    vec2 a = map_place(from), b = map_place(to);
    vec2 after = ends ? b : map_place(vertex_at(segment.w));
    LineRecord line = line_at(from.line);
    uint slot = line.slot;
    uint flags = (begins ? SEGMENT_BEGINS : 0u) | (ends ? SEGMENT_ENDS : 0u);
    if (!ends && turns(b - a, after - b)) flags |= SEGMENT_TURNS;
    if (!begins && turns(a - map_place(vertex_at(segment.x)), b - a)) flags |= SEGMENT_TURNED;
    if ((line.flags & LINE_INSIDE_RIGHT) != 0u) flags |= SEGMENT_INSIDE_RIGHT;

    ProjectedSegment seen = project(ground_place(from), ground_place(to));
    vec3 across = ray_origin_dx.xyz + max(seen.nearest, base_offset.w) * ray_direction_dx.xyz;
    float reach = shown_reach(slot, inversesqrt(dot(across, across)));
#ifdef LENS
    first_style = lens_styles;
    reach = max(reach, shown_reach(slot, inversesqrt(dot(across, across))));
    first_style = 0;
#endif
    vec2 low = min(seen.from, seen.to) - reach, high = max(seen.from, seen.to) + reach;
    bool inside = all(greaterThan(high, vec2(0.0))) && all(lessThan(low, spacing.zw));
    uint record = this_record();
    segment_ends[record] = vec4(a, b);
    segment_joints[record] = uvec4(floatBitsToUint(after), slot, flags);
#ifdef STYLED
    segment_arcs[record] = arcs_of(segment, length(b - a), slot);
#endif
    segment_spans[record] = vec4(seen.from, seen.to);
    segment_reaches[record] = there && seen.seen && inside && reach > 0.0 ? reach : -1.0;
}

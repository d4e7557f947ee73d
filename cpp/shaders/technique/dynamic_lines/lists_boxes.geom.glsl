// A box around each segment that holds all ground that it may cover (Zechmeister 2020, algorithms 3.3 and 3.4).
//
//     from above     +---.                          as high as the terrain, and somewhat higher
//                    |    `--.  +
//                    +---.    `/ |    neighbours meet in a common surface, the corner's miter, where both are long
//                         `-. /  |    enough and turn little; elsewhere, and at ends, boxes go on by their reach
//                            +---+
//
// By width_rule "screen" boxes never meet in a miter: two lines' distances are equal there on the map alone, and not on
// the screen. Widths grow with the distance, so that of the farthest corner holds for all (equations 4.1 and 4.2).
//
// THESIS   widths by the distance from the eye; else by the depth, as the screen has it
// JOINED   corners and caps that are not round
// STYLED   patterns along lines, and colours across; goes with JOINED
// SIDES    inset and offset outlines
// LIMITS   widths that depend on the depth
// LENS     other looks inside the lens
#include "technique/dynamic_lines/line_looks.glsl"
#include "technique/dynamic_lines/project.glsl"
#ifdef STYLED
#include "technique/dynamic_lines/segment_arcs.glsl"
#endif

layout(points) in;
layout(triangle_strip, max_vertices = 14) out;

flat in int segment_index[];

flat out vec4 part_ends;    // on the map, relative to the base: from x, y; to x, y
flat out vec4 part_joints;  // the vertices before and after
flat out uvec2 part_line;   // slot; 1: begins here, 2: ends here, 4: its polygon lies to the right

#ifdef STYLED
flat out uvec2 part_arcs;
#endif

uniform usamplerBuffer line_segments;
uniform vec2 ground_heights;  // the lowest and the highest, metres from the view's base

bool is_perspective() {
    return dot(ray_direction_dx.xyz, ray_direction_dx.xyz) > 0.0;
}

// Of an end of the segment, at whatever height of the terrain.
float farthest_depth(vec2 end) {
    return dot(end, forward.xy) + max(forward.z * ground_heights.x, forward.z * ground_heights.y);
}

float farthest_from_eye(vec2 end) {
    vec3 eye = -forward.w * forward.xyz;
    float up = max(abs(ground_heights.x - eye.z), abs(ground_heights.y - eye.z));
    return length(vec3(end - eye.xy, up));
}

// Metres that a pixel is wide at a depth beyond the base, seen head-on.
float metres_of_pixel(float depth) {
    return length(ray_origin_dx.xyz + depth * ray_direction_dx.xyz);
}

float half_width_in_metres(LineLook look, uint slot, float pixel) {
    return pixel * half_width_in_pixels(look, slot, 1.0 / pixel);
}

#ifdef LENS
float widest(uint slot, float pixel) {
    first_style = lens_styles;
    float inside = half_width_in_metres(look_of(slot), slot, pixel);
    first_style = 0;
    return max(inside, half_width_in_metres(look_of(slot), slot, pixel));
}
#else
float widest(uint slot, float pixel) {
    return half_width_in_metres(look_of(slot), slot, pixel);
}
#endif

struct BoxReach {
    float across;
    float along;
};

// Half the width, and how far ends reach beyond their vertices: to a miter's tip, or a square cap's corners.
BoxReach reach_of_box(vec2 a, vec2 b, uint slot) {
    uint kind = look_of(slot).kind;
    float tip = 1.0, corner = 1.0;
#ifdef JOINED
    if (corner_of(kind) == 1u) tip = max(1.0, 1.0 / tan(0.5 * miter_limit(kind)));
    corner = joint_reach(kind);
#endif
#ifdef THESIS
    float scale = is_perspective() ? length(ray_direction_dx.xyz) : length(ray_origin_dx.xyz);
    float farthest = is_perspective() ? max(farthest_from_eye(a), farthest_from_eye(b)) : 1.0;
    float width = widest(slot, scale * farthest) + 0.1 * scale * farthest;
    // Ground beside the line may lie farther away than its ends do, by as much as the line is wide.
    width /= 1.0 - min(is_perspective() ? 1.5 * width / farthest : 0.0, 0.5);
    return BoxReach(width, width * tip);
#else
    float depth = max(max(farthest_depth(a), farthest_depth(b)), base_offset.w);
    float pixel = metres_of_pixel(depth);
    // On the screen a corner's tip may point anywhere.
    float width = widest(slot, pixel) * corner + pixel;
    return BoxReach(width, width);
#endif
}

struct BoxEnd {
    vec2 side;  // from the vertex to the left
    float beyond;
};

// `before` and `after`: of a corner, whichever way the line runs.
BoxEnd box_end(vec2 before, vec2 vertex, vec2 after, vec2 along, BoxReach reach, bool is_end) {
    vec2 left = vec2(-along.y, along.x);
    BoxEnd straight = BoxEnd(reach.across * left, reach.along);
#ifdef THESIS
    vec2 incoming = vertex - before, outgoing = after - vertex;
    float length_in = length(incoming), length_out = length(outgoing);
    bool is_long = min(length_in, length_out) > 1.6 * reach.across;
    vec2 bisector = incoming / max(length_in, 1e-9) + outgoing / max(length_out, 1e-9);
    float opening = 0.5 * length(bisector);  // the cosine of half the turn
    vec2 miter = vec2(-bisector.y, bisector.x) / max(2.0 * opening * opening, 1e-6);
    if (!is_end && is_long && opening > 0.8661) return BoxEnd(reach.across * miter, 0.0);
#endif
    return straight;
}

struct Part {
    vec4 ends;
    vec4 joints;
    uvec2 line;
    uvec2 arcs;
};

void emit(vec3 corner, Part part) {
    part_ends = part.ends;
    part_joints = part.joints;
    part_line = part.line;
#ifdef STYLED
    part_arcs = part.arcs;
#endif
    gl_Position = clip_from_base * vec4(corner, 1.0);
    EmitVertex();
}

void main() {
    uvec4 segment = texelFetch(line_segments, segment_index[0]);
    MatchedVertex from = vertex_at(segment.y), to = vertex_at(segment.z);
    bool begins = segment.x == NO_VERTEX, ends = segment.w == NO_VERTEX;
    vec2 a = map_place(from), b = map_place(to);
    vec2 before = begins ? a : map_place(vertex_at(segment.x)), after = ends ? b : map_place(vertex_at(segment.w));
    LineRecord record = line_at(from.line);
    uint slot = record.slot;
    vec2 along = length(b - a) > 1e-9 ? normalize(b - a) : vec2(1.0, 0.0);
    BoxReach reach = reach_of_box(a, b, slot);
    BoxEnd first = box_end(before, a, b, along, reach, begins), last = box_end(a, b, after, along, reach, ends);
    vec2 heights = ground_heights + vec2(-reach.across, reach.across);
    uint flags = (begins ? 1u : 0u) | (ends ? 2u : 0u) | ((record.flags & LINE_INSIDE_RIGHT) != 0u ? 4u : 0u);
    uvec2 line = uvec2(slot, flags), arcs = uvec2(0u);
#ifdef STYLED
    arcs = arcs_of(segment, length(b - a), slot);
#endif
    Part part = Part(vec4(a, b), vec4(before, after), line, arcs);
    // Fourteen corners make a strip of all six sides (Evans et al. 1996): bits of right, end and high.
    for (int i = 0; i < 14; ++i) {
        bool left = (0x287a >> i & 1) == 0, at_end = (0x02af >> i & 1) != 0, high = (0x31e3 >> i & 1) != 0;
        BoxEnd end = first;
        if (at_end) end = last;
        vec2 place = (at_end ? b + end.beyond * along : a - end.beyond * along) + (left ? end.side : -end.side);
        emit(vec3(place, high ? heights.y : heights.x), part);
    }
    EndPrimitive();
}

// Boxes around segments, over all the ground that a segment's field may lie on: every pixel that may see it is
// inside, and is drawn once, by the box's far side. So the eye may be inside too.
//
//          +-----------+
//         /|  o─────o /|      as wide as the field reaches, and some pixels more at either end
//        +-----------+ |      as high as the ground under it; some pixels more for coarser levels of the terrain
//        | +---------|-+
//        |/          |/
//        +-----------+
//
// After Trapp et al. 2015, section 5.2, whose boxes are flat. Boxes out of sight are left out.
//
// VERTEX_WIDTHS   a segment is as wide as the level of detail at its nodes says
// IDS             all categories go into one picture
#include "technique/distance_field/styles.glsl"

layout(points) in;
layout(triangle_strip, max_vertices = 14) out;

flat in uvec4 point_segment[];
flat in uvec2 point_rest[];

uniform isamplerBuffer network_nodes;
uniform usamplerBuffer network_slots;
uniform int block_shift;
uniform float quantum;
uniform float widest;       // half width of the widest category, of which clearances are shares
uniform float spare_pixels;  // around each box
uniform vec2 height_steps;  // height of the lowest ground, and what 16 bits count

flat out ivec2 start_block;
flat out vec2 start_offset;
flat out vec4 way;           // direction on the map, length, metres along the line at its start
flat out vec4 widths;        // half widths at both ends; how far their caps reach
flat out ivec4 kinds;        // category, shapes of the caps (0: none), order

const float no_cut = 1e30;
const float clearance_steps = 16777215.0;

struct Node {
    ivec2 block;
    vec2 offset;
    int grade;
    float clearance;
};

Node node_at(uint index) {
    ivec3 texel = texelFetch(network_nodes, int(index)).xyz;
    uint marks = uint(texel.z);
    ivec2 block = texel.xy >> block_shift;
    vec2 offset = vec2(texel.xy & ((1 << block_shift) - 1)) * quantum;
    float clearance = float(marks >> NODE_CLEARANCE_SHIFT) / clearance_steps * widest;
    return Node(block, offset, int(marks & uint(NODE_GRADE_MASK)), clearance);
}

vec2 relative_to_base(Node node) {
    return vec2(node.block - base_block.xy) * base_offset.z + (node.offset - base_offset.xy);
}

// Of a place relative to the base.
Seen seen_at(vec3 place) {
    vec4 clip = clip_from_base * vec4(place, 1.0);
    vec2 screen = clip.w > 0.0 ? 0.5 + 0.5 * clip.xy / clip.w : vec2(0.5);
    return Seen(place.xy, forward.w + dot(place, forward.xyz), dot(place, camera_right()), screen);
}

float pixel_size(vec3 place) {
    float size = length(ray_origin_dy.xyz) + dot(place, forward.xyz) * length(ray_direction_dy.xyz);
    return max(size, 0.0);
}

// How a line's end is drawn: by the grade of its node. Where the line goes on, its next segment draws the joint.
int cap_at(int category, Node node, bool line_ends, bool joint) {
    vec4 caps = category_texel(category, 1);
    int grade = clamp(node.grade, 1, 4) - 1;
    float cap = grade == 0 ? caps.x : grade == 1 ? caps.y : grade == 2 ? caps.z : caps.w;
    return line_ends ? int(cap) : joint ? 1 : 0;
}

float half_width_at(int category, Node node, vec3 place) {
    Category own = category_at(category);
#ifdef VERTEX_WIDTHS
    return min(style_at(own, lod_at(seen_at(place))).half_width, node.clearance);
#else
    return own.reach;
#endif
}

float cut_at(uint ends, int shift, vec3 place) {
    int category = int(ends >> shift & CUT_MASK) - 1;
    if (category < 0) return no_cut;
    return style_at(category_at(category), lod_at(seen_at(place))).half_width;
}

bool out_of_sight(vec4 corners[8]) {
    ivec4 beyond = ivec4(0);
    int behind = 0;
    for (int i = 0; i < 8; ++i) {
        vec4 c = corners[i];
        beyond += ivec4(c.x < -c.w, c.x > c.w, c.y < -c.w, c.y > c.w);
        behind += int(c.w <= 0.0);
    }
    return behind == 8 || any(equal(beyond, ivec4(8)));
}

void main() {
    uvec4 segment = point_segment[0];
    uvec2 rest = point_rest[0];
    uvec2 slot = texelFetch(network_slots, int(segment.z)).xy;
    uint low = segment.w & 0xFFFFu, high = segment.w >> 16;
    if (slot.x == 0xFFFFFFFFu || low > high) return;
    int category = int(slot.x);
    Node a = node_at(segment.x), b = node_at(segment.y);
    vec2 on_map = vec2(b.block - a.block) * base_offset.z + (b.offset - a.offset);
    float size = length(on_map);
    vec2 direction = size > 0.0 ? on_map / size : vec2(1.0, 0.0);
    vec2 heights = height_steps.x + height_steps.y * vec2(low, high);
    heights = (heights - base_sample_fraction.z) - base_sample_fraction.w;
    vec3 place_a = vec3(relative_to_base(a), 0.5 * (heights.x + heights.y));
    vec3 place_b = vec3(relative_to_base(b), place_a.z);
    uint ends = rest.y;
    vec2 half_widths = vec2(half_width_at(category, a, place_a), half_width_at(category, b, place_b));
    if (max(half_widths.x, half_widths.y) <= 0.0) return;

    float scale = category_at(category).margin_scale;
    vec2 spare = spare_pixels * vec2(pixel_size(place_a), pixel_size(place_b));
    vec2 reach = half_widths * FIELD_SLACK + (1.0 + scale) * spare;
    vec2 across = vec2(-direction.y, direction.x);
    vec4 corners[8];
    for (int i = 0; i < 8; ++i) {
        bool at_b = (i & 1) != 0;
        float own = at_b ? reach.y : reach.x;
        float up = at_b ? spare.y : spare.x;
        vec2 flat_place = (at_b ? place_b.xy + own * direction : place_a.xy - own * direction)
                          + ((i & 2) != 0 ? own : -own) * across;
        float height = (i & 4) != 0 ? heights.y + up : heights.x - up;
        corners[i] = clip_from_base * vec4(flat_place, height, 1.0);
        corners[i].xy -= 2.0 * jitter.xy / spacing.zw * corners[i].w;
    }
    if (out_of_sight(corners)) return;

    ivec4 own_kinds = ivec4(category,
                            cap_at(category, a, (ends & LINE_ENDS_AT_A) != 0u, (ends & PLAIN_A) == 0u),
                            cap_at(category, b, (ends & LINE_ENDS_AT_B) != 0u, false), int(slot.y));
    vec4 own_widths = vec4(half_widths, cut_at(ends, CUT_A_SHIFT, place_a), cut_at(ends, CUT_B_SHIFT, place_b));
    // A strip around the box: bit i of each number is the coordinate of vertex i.
    for (int i = 0; i < 14; ++i) {
        int corner = (0x287A >> i & 1) | (0x02AF >> i & 1) << 1 | (0x31E3 >> i & 1) << 2;
        gl_Position = corners[corner];
#ifndef IDS
        gl_Layer = category;
#endif
        start_block = a.block;
        start_offset = a.offset;
        way = vec4(direction, size, uintBitsToFloat(rest.x));
        widths = own_widths;
        kinds = own_kinds;
        EmitVertex();
    }
    EndPrimitive();
}

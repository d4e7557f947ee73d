// A pixel inside a segment's box: if the line covers it, it gets an entry (Zechmeister 2020, section 4.3.2).
//
// THESIS   distances on the map, by widths that grow with the distance (equations 4.1 and 4.2); else on the screen
// JOINED   corners and caps that are not round
// STYLED   patterns along lines, and colours across; goes with JOINED
// SIDES    inset and offset outlines
// LIMITS   widths that depend on the depth
// LENS     other looks inside the lens
#include "shared/stroke.glsl"
#include "technique/dynamic_lines/line_entry.glsl"
#include "technique/dynamic_lines/line_looks.glsl"
#ifdef STYLED
#include "technique/dynamic_lines/line_patterns.glsl"
#endif
#include "technique/dynamic_lines/line_point.glsl"
#include "technique/dynamic_lines/lists_buffers.glsl"
#include "technique/dynamic_lines/ring_sides.glsl"
#include "technique/dynamic_lines/screen_plane.glsl"

flat in vec4 part_ends;
flat in vec4 part_joints;
flat in uvec2 part_line;

#ifdef STYLED
flat in uvec2 part_arcs;
#endif

uniform sampler2D surface_texture;
uniform uint entry_room;
uniform uint longest_list;
#ifdef LENS
uniform sampler2D lens_texture;
#endif

bool begins() {
    return (part_line.y & 1u) != 0u;
}

bool ends() {
    return (part_line.y & 2u) != 0u;
}

// Shares of the width that the pattern leaves at a share of the way on the map, and at both ends.
vec3 marks_at(LineLook look, float share, float pixels_per_metre) {
    vec3 marks = vec3(1.0);
#ifdef STYLED
    if (look.pattern != NO_PATTERN) marks = widths_along(phases_of(look.pattern, part_arcs, pixels_per_metre), share);
#endif
    return marks;
}

// The segment as this pixel has it: in metres on the map, or in pixels on the screen.
struct PixelPart {
    LinePart part;
    float share;  // of the segment, where its line comes nearest
    float half_width;
    bool seen;
};

#ifdef THESIS

PixelPart pixel_part(vec2 pixel, ScreenPlane plane, LineLook look) {
    // Where the ray is longer than the depth, a pixel stands for more metres.
    float pixels_per_metre = plane.pixels_per_metre / length(ray_direction_at(pixel));
    float half_width = half_width_in_pixels(look, part_line.x, pixels_per_metre) / pixels_per_metre;
    vec4 at = part_ends - plane.place.xyxy;
    vec2 way = at.zw - at.xy;
    float share = -dot(at.xy, way) / max(dot(way, way), 1e-12);
    vec2 direction = unit_vector(way);
    vec2 incoming = unit_vector(part_ends.xy - part_joints.xy), outgoing = unit_vector(part_joints.zw - part_ends.zw);
    LinePart part = LinePart(at.xy, at.zw, incoming, outgoing, begins(), ends(),
                             turns(incoming, direction), turns(direction, outgoing),
                             marks_at(look, share, pixels_per_metre));
    return PixelPart(part, share, half_width, true);
}

bool is_covered(PixelPart at, LineLook look) {
    return covers(at.part, look, at.half_width);
}

// Whether left on the map is left here.
bool is_left_on_map(ScreenPlane plane) {
    return true;
}

#else

vec2 direction_on_screen(ScreenPlane plane, vec4 ends) {
    ScreenSegment segment = on_screen(plane, ends);
    return unit_vector(segment.to - segment.from);
}

PixelPart pixel_part(vec2 pixel, ScreenPlane plane, LineLook look) {
    float half_width = half_width_in_pixels(look, part_line.x, plane.pixels_per_metre);
    ScreenSegment segment = on_screen(plane, part_ends);
    float share = foot_share(segment);
    vec2 outgoing = direction_on_screen(plane, vec4(part_ends.zw, part_joints.zw));
    vec2 direction = unit_vector(segment.to - segment.from);
    LinePart part = LinePart(segment.from, segment.to, vec2(0.0), outgoing, begins(), ends(), false,
                             turns(direction, outgoing),
                             marks_at(look, share_on_map(segment, share).x, plane.pixels_per_metre));
#if defined(JOINED) || defined(SIDES)
    part.incoming = direction_on_screen(plane, vec4(part_joints.xy, part_ends.xy));
    part.turned = turns(part.incoming, direction);
#endif
    return PixelPart(part, share, half_width, segment.seen && is_on_ground(plane, segment, part_ends, half_width));
}

bool is_covered(PixelPart at, LineLook look) {
    return decides(at.part, at.share) && covers(at.part, look, at.half_width);
}

bool is_left_on_map(ScreenPlane plane) {
    return determinant(plane.to_screen) > 0.0;
}

#endif

#ifdef SIDES

// What the list has to know of a ring's segment: how near it comes, whether its side is kept, whether it covers.
uint aside_of(PixelPart at, LineLook look, bool covered, bool keeps_left) {
    LinePart part = at.part;
    vec2 way = part.to - part.from, direction = unit_vector(way);
    float turn = 0.0;
    if (at.share < 0.0 && !part.begins) turn = cross_product(part.incoming, direction);
    if (at.share > 1.0 && !part.ends) turn = cross_product(direction, part.outgoing);
    bool inside_left = ((part_line.y & 4u) == 0u) == keeps_left;
    bool kept = is_kept(is_inside_ring(part.from, direction, turn, inside_left), look.kind);
    return aside_word(length(part.from + clamp(at.share, 0.0, 1.0) * way), kept, covered);
}

#endif

void append(uint list, uint line, vec4 color, uint aside) {
    uint entry = atomicAdd(entry_total, 1u);
    if (entry >= entry_room) return;
    entries[entry] = uvec2(line, packUnorm4x8(color));
#ifdef SIDES
    asides[entry] = aside;
#endif
    next[entry] = atomicExchange(heads[list], entry);
    if (atomicAdd(counts[list], 1u) >= longest_list) is_too_long = 1u;
}

void main() {
    ivec2 place = ivec2(gl_FragCoord.xy);
    vec4 surface = texelFetch(surface_texture, place, 0);
    if (isinf(surface.z)) return;
#ifdef LENS
    if (texelFetch(lens_texture, place, 0).g > 0.5) first_style = lens_styles;
#endif
    LineLook look = look_of(part_line.x);
    if (!takes_room(look)) return;
    vec2 pixel = pixel_from_centre();
    ScreenPlane plane = screen_plane(pixel, surface);
    PixelPart at = pixel_part(pixel, plane, look);
    if (!at.seen || at.half_width <= 0.0) return;
    bool covered = is_covered(at, look), is_entry = covered;
    uint aside = shown_anyway;
#ifdef SIDES
    // The nearest segment tells the side, and need not be the one that covers.
    if ((look.kind & (INSIDE_ONLY | OUTSIDE_ONLY)) != 0u) {
        is_entry = distance_to_part(at.part) <= at.half_width * joint_reach(look.kind);
        aside = aside_of(at, look, covered, is_left_on_map(plane));
    }
#endif
    if (is_entry) append(list_of(place), line_entry(part_line.x, look.kind), look.color, aside);
}

// Lines out of the tiles of the screen (bins_layout.h): a pixel looks through its tile's segments from the topmost down.
//
// Each segment lies on the plane of the ground that this pixel sees (screen_plane.glsl), so lines bend over the terrain
// and hide behind it without a depth of their own.
//
// COVERAGE      64 samples of the pixel at once (shared/sample_masks.glsl)
// UNION         all that is shown looks the same and is opaque; not with IDS
// TRANSLUCENT   some colour is
// JOINED        corners and caps that are not round
// LIMITS        widths that depend on the depth
// LENS          other looks inside the lens
// GATHERED      texels are samples of pixels from anywhere in the picture
// IDS           1 + slot at the pixel's centre
#include "shared/position.glsl"
#include "technique/dynamic_lines/bins_layout.h"
#include "technique/dynamic_lines/line_looks.glsl"
#include "technique/dynamic_lines/line_masks.glsl"
#include "technique/dynamic_lines/screen_plane.glsl"
#include "technique/dynamic_lines/tile_range.glsl"

uniform usamplerBuffer tile_list;
uniform samplerBuffer segment_ends;
uniform usamplerBuffer segment_joints;
uniform sampler2D surface_texture;
#ifdef LENS
uniform sampler2D lens_texture;
#endif

#ifdef IDS
layout(location = 0) out uint out_id;
#else
layout(location = 0) out vec4 out_color;  // premultiplied
#endif

const uint no_slot = 0xFFFFFFFFu;

ivec2 list_range() {
#ifdef GATHERED
    ivec2 pixel = gathered_pixel();
#else
    ivec2 pixel = ivec2(gl_FragCoord.xy);
#endif
    ivec2 tile = (pixel + picture.xy) / TILE_SIDE;
    return range_of_tile(tile.y * tile_grid.x + tile.x);
}

// The distance of the pixel's centre.
float distance_to(ScreenSegment segment) {
    vec2 way = segment.to - segment.from;
    float share = clamp(-dot(segment.from, way) / max(dot(way, way), 1e-12), 0.0, 1.0);
    return length(segment.from + share * way);
}

vec2 direction_of_segment(ScreenSegment segment) {
    vec2 way = segment.to - segment.from;
    float across = length(way);
    return across > 1e-9 ? way / across : vec2(1.0, 0.0);
}

struct Joints {
    vec2 next;  // on the map
    uint slot;
    uint flags;
};

Joints joints_at(int segment) {
    uvec4 texel = texelFetch(segment_joints, segment);
    return Joints(uintBitsToFloat(texel.xy), texel.z, texel.w);
}

float miter_cosine(uint kind) {
    return cos(radians(float(kind >> MITER_SHIFT) / 256.0));
}

uint corner_of(uint kind) {
    return kind & CORNER_MASK;
}

uint cap_of(uint kind) {
    return kind >> CAP_SHIFT & 3u;
}

// The direction on the screen in which the line goes on from a segment's end.
vec2 next_direction(ScreenPlane plane, vec4 ends, Joints joints) {
    return direction_of_segment(on_screen(plane, vec4(ends.zw, joints.next)));
}

#ifdef COVERAGE

// A corner that is not round, in the gap between two bars.
uvec2 corner_mask(vec2 at, vec2 incoming, vec2 outgoing, float half_width, uint kind) {
    float turn = cross_product(incoming, outgoing), straight = dot(incoming, outgoing);
    bool sharp = corner_of(kind) == miter_corner && straight < -miter_cosine(kind) - 1e-6;
    float opening = 0.5 * length(incoming + outgoing);
    uvec2 mask = disc_mask(at, half_width);
    if (!sharp && opening > 1e-6) {
        float side = turn > 0.0 ? 1.0 : -1.0;  // the gap lies to the other side of the turn
        vec2 out_a = side * vec2(incoming.y, -incoming.x), out_b = side * vec2(outgoing.y, -outgoing.x);
        mask = beyond_line(at, incoming) & beyond_line(at, -outgoing);
        mask &= beyond_line(at + half_width * out_a, -out_a) & beyond_line(at + half_width * out_b, -out_b);
        if (corner_of(kind) == bevel_corner) {
            vec2 outwards = normalize(out_a + out_b);
            mask &= beyond_line(at + half_width * opening * outwards, -outwards);
        }
        if (abs(turn) < 1e-4) mask = no_samples;
    }
    return mask;
}

// Of round ends: at a bend the disc of the segment that ends there is enough.
uvec2 ends_mask(Stroke stroke, bool at_from, bool at_to) {
    uvec2 mask = no_samples;
    bool more = true;
    do {
        // Both ends are round only where a line has one segment.
        bool here = at_from && more;
        vec2 centre = here ? stroke.from : stroke.to, outwards = here ? -stroke.direction : stroke.direction;
        uvec2 disc = disc_mask(centre, stroke.half_width) & beyond_line(centre, outwards);
        mask |= at_from || at_to ? disc : no_samples;
        more = here && at_to;
        at_from = at_from && here && !more;
    } while (more);
    return mask;
}

uvec2 segment_mask(ScreenPlane plane, vec4 ends, ScreenSegment segment, Joints joints, LineLook look, float half_width) {
    Stroke stroke = Stroke(segment.from, segment.to, direction_of_segment(segment), half_width);
    bool begins = (joints.flags & SEGMENT_BEGINS) != 0u, finishes = (joints.flags & SEGMENT_ENDS) != 0u;
    bool turns = (joints.flags & SEGMENT_TURNS) != 0u;
    const float overlap = 0.01;  // so that rounding opens no gap
#ifdef JOINED
    bool joined = corner_of(look.kind) != round_corner, capped = cap_of(look.kind) == round_cap;
    float cap = cap_of(look.kind) == square_cap ? half_width : 0.0;
    vec2 longer = vec2(begins ? cap : overlap, finishes ? cap : overlap);
    uvec2 mask = bar_mask(stroke, longer) | ends_mask(stroke, begins && capped, finishes ? capped : turns && !joined);
    float near = half_width + half_diagonal;
    if (joined && !finishes && dot(segment.to, segment.to) < 16.0 * near * near)
        mask |= corner_mask(segment.to, stroke.direction, next_direction(plane, ends, joints), half_width, look.kind);
    return mask;
#else
    vec2 longer = vec2(begins ? 0.0 : overlap, finishes ? 0.0 : overlap);
    return bar_mask(stroke, longer) | ends_mask(stroke, begins, finishes || turns);
#endif
}

struct Samples {
    uvec2 open;
    vec4 sum;
#ifdef TRANSLUCENT
    float clear[sample_count];  // how much of what lies behind shows through
#endif
};

void add_line(inout Samples samples, uvec2 mask, vec4 straight) {
    mask &= samples.open;
#ifdef TRANSLUCENT
    float weight = 0.0;
    int i = 0;
    if (!is_empty(mask)) {
        do {
            float taken = has_sample(mask, i) ? samples.clear[i] * straight.a : 0.0;
            samples.clear[i] -= taken;
            weight += taken;
        } while (++i < sample_count);
    }
    if (straight.a == 1.0) samples.open &= ~mask;
#else
    float weight = float(count_of(mask));
    samples.open &= ~mask;
#endif
    samples.sum += weight * vec4(straight.rgb, 1.0);
}

vec4 composed(ScreenPlane plane, ivec2 range) {
    Samples samples;
    samples.open = all_samples;
    samples.sum = vec4(0.0);
#ifdef TRANSLUCENT
    for (int i = 0; i < sample_count; ++i) samples.clear[i] = 1.0;
#endif
    uint slot = no_slot;
    uvec2 covered = no_samples;
    LineLook look = LineLook(vec4(0.0), 0.0, 0u);
    float half_width = 0.0;
#ifdef UNION
    look = look_of(0u);
    half_width = half_width_in_pixels(look, 0u, plane.pixels_per_metre);
#endif
    int at = range.y - 1;
    bool ended = at < range.x;
    do {
        // On to the next segment whose border passes through the pixel. What a turn works out is lost when neighbouring
        // pixels take more turns (llvmpipe); only what is carried from turn to turn is there afterwards.
        bool border = false;
        do {
            int index = int(texelFetch(tile_list, max(at, 0)).r);
            ScreenSegment segment = on_screen(plane, texelFetch(segment_ends, index));
#ifndef UNION
            uint own_slot = texelFetch(segment_joints, index).z;
            if (own_slot != slot && !ended) {
                if (!is_empty(covered)) add_line(samples, covered, look.color);
                covered = no_samples;
                slot = own_slot;
                look = look_of(slot);
                half_width = half_width_in_pixels(look, slot, plane.pixels_per_metre);
                ended = is_empty(samples.open);
            }
#endif
            float distance = distance_to(segment);
            bool near = !ended && segment.seen && half_width > 0.0 && covered != all_samples;
#ifdef JOINED
            border = border || (near && distance < 4.0 * half_width + half_diagonal);
#else
            if (near && distance <= half_width - half_diagonal) {
                covered = all_samples;
                near = false;
            }
            border = border || (near && distance < half_width + half_diagonal);
#endif
            --at;
            ended = ended || (at < range.x && !border);
#ifdef UNION
            ended = ended || covered == all_samples;
#endif
        } while (!border && !ended);
        if (border) {
            int index = int(texelFetch(tile_list, at + 1).r);
            vec4 ends = texelFetch(segment_ends, index);
            covered |= segment_mask(plane, ends, on_screen(plane, ends), joints_at(index), look, half_width);
            ended = at < range.x;
        }
    } while (!ended);
    if (!is_empty(covered)) add_line(samples, covered, look.color);
    return samples.sum / float(sample_count);
}

#else

#ifdef JOINED
// Corners and caps that are not round, by the place of the pixel's centre alone.
bool covers(ScreenPlane plane, vec4 ends, ScreenSegment segment, Joints joints, LineLook look, float half_width) {
    vec2 direction = direction_of_segment(segment);
    bool begins = (joints.flags & SEGMENT_BEGINS) != 0u, finishes = (joints.flags & SEGMENT_ENDS) != 0u;
    float cap = cap_of(look.kind) == square_cap ? half_width : 0.0;
    const float overlap = 1e-3;
    vec2 longer = vec2(begins ? cap : overlap, finishes ? cap : overlap);
    float across = cross_product(direction, -segment.from);
    float reach = bar_reach(-segment.from, -segment.to, direction, across, longer);
    bool joined = corner_of(look.kind) != round_corner;
    if (begins ? cap_of(look.kind) == round_cap : !joined) reach = min(reach, length(segment.from));
    if (finishes ? cap_of(look.kind) == round_cap : !joined) reach = min(reach, length(segment.to));
    if (joined && !finishes) {
        vec2 outgoing = next_direction(plane, ends, joints);
        reach = min(reach, corner_reach(corner_of(look.kind), -segment.to, direction, outgoing, miter_cosine(look.kind)));
    }
    return reach <= half_width;
}
#endif

// What covers the pixel's centre: colours over each other, or the topmost slot.
vec4 composed(ScreenPlane plane, ivec2 range, out uint topmost) {
    vec4 sum = vec4(0.0);
    uint slot = no_slot;
    bool covered = false;
    topmost = no_slot;
    LineLook look = LineLook(vec4(0.0), 0.0, 0u);
    float half_width = 0.0;
    int at = range.y - 1;
    bool ended = at < range.x;
#ifdef UNION
    look = look_of(0u);
    half_width = half_width_in_pixels(look, 0u, plane.pixels_per_metre);
#endif
    do {
        int index = int(texelFetch(tile_list, max(at, 0)).r);
        vec4 ends = texelFetch(segment_ends, index);
        ScreenSegment segment = on_screen(plane, ends);
#if !defined(UNION) || defined(JOINED)
        Joints joints = joints_at(index);
#endif
#ifndef UNION
        if (joints.slot != slot) {
            slot = joints.slot;
            look = look_of(slot);
            half_width = half_width_in_pixels(look, slot, plane.pixels_per_metre);
            covered = false;
        }
#endif
        bool open = !ended && segment.seen && !covered && look.color.a > 0.0 && half_width > 0.0;
#ifdef JOINED
        bool hit = open && distance_to(segment) <= 4.0 * half_width &&
                   covers(plane, ends, segment, joints, look, half_width);
#else
        bool hit = open && distance_to(segment) <= half_width;
#endif
        if (hit) {
            covered = true;
            if (topmost == no_slot) topmost = slot;
            float weight = (1.0 - sum.a) * look.color.a;
            sum += weight * vec4(look.color.rgb, 1.0);
        }
        --at;
#ifdef IDS
        ended = ended || at < range.x || topmost != no_slot;
#else
        ended = ended || at < range.x || sum.a >= 0.999;
#endif
    } while (!ended);
    return sum;
}

#endif

#ifdef IDS

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 surface = texelFetch(surface_texture, pixel, 0);
    out_id = 0u;
    if (isinf(surface.z)) return;
#ifdef LENS
    if (texelFetch(lens_texture, pixel, 0).g > 0.5) first_style = lens_styles;
#endif
    uint topmost;
    composed(screen_plane(pixel_from_centre(), surface), list_range(), topmost);
    if (topmost != no_slot) out_id = topmost + 1u;
}

#else

vec4 color_in(ScreenPlane plane, ivec2 range) {
#ifdef COVERAGE
    return composed(plane, range);
#else
    uint topmost;
    return composed(plane, range, topmost);
#endif
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 surface = texelFetch(surface_texture, pixel, 0);
    out_color = vec4(0.0);
    if (isinf(surface.z)) return;
    ScreenPlane plane = screen_plane(pixel_from_centre(), surface);
#ifdef LENS
    float inside = texelFetch(lens_texture, pixel, 0).r;
    vec4 outer = color_in(plane, list_range());
    first_style = lens_styles;
    vec4 inner = color_in(plane, list_range());
    out_color = mix(outer, inner, inside);
#else
    out_color = color_in(plane, list_range());
#endif
}

#endif

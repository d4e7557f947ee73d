// What covers the samples of a pixel, 64 of them at once: colours over each other.
#include "shared/composed_samples.glsl"
#include "technique/dynamic_lines/line_masks.glsl"

const float overlap = 0.01;  // pixels, so that rounding opens no gap between bars

// A corner that is not round, in the gap between two bars.
uvec2 corner_mask(vec2 at, vec2 incoming, vec2 outgoing, float half_width, uint kind) {
    float turn = cross_product(incoming, outgoing), straight = dot(incoming, outgoing);
    bool sharp = corner_of(kind) == miter_corner && straight < -cos(miter_limit(kind)) - 1e-6;
    float opening = 0.5 * length(incoming + outgoing);
    uvec2 mask = disc_mask(at, half_width);
    if (!sharp && opening > 1e-6) {
        float side = turn > 0.0 ? 1.0 : -1.0;  // the gap lies to the other side of the turn
        vec2 out_a = side * vec2(incoming.y, -incoming.x), out_b = side * vec2(outgoing.y, -outgoing.x);
        mask = wedge_mask(at, incoming, outgoing);
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

#ifdef STYLED

// The mark of a pattern that comes nearest to the pixel, and the next one of its kind on the other side.
uvec2 mark_mask(vec4 mark, Stroke stroke, float phase, vec2 foot, float period) {
    vec2 normal = vec2(-stroke.direction.y, stroke.direction.x);
    float middle = 0.5 * (mark.x + mark.y), place = phase - middle;
    place -= round(place);
    uvec2 mask = no_samples;
    int i = 0;
    do {
        vec2 start = foot + stroke.direction * (period * (mark.x - middle - place));
        vec2 end = foot + stroke.direction * (period * (mark.y - middle - place));
        uvec2 own = beyond_line(start, stroke.direction) & beyond_line(end, -stroke.direction);
        if (min(mark.z, mark.w) < 1.0) {
            vec2 first = stroke.half_width * mark.z * normal, last = stroke.half_width * mark.w * normal;
            vec2 upper = end + last - start - first, lower = end - last - start + first;
            own &= beyond_line(start + first, vec2(upper.y, -upper.x)) & beyond_line(start - first, vec2(-lower.y, lower.x));
        }
        mask |= own;
        place -= place > 0.0 ? 1.0 : -1.0;
    } while (++i < 2);
    return mask;
}

// Of all marks; `stroke` has the whole line's width. Where a period is less than a pixel, as many samples as marks take of it.
uvec2 marks_mask(SeenSegment seen, Stroke stroke) {
    vec2 way = stroke.to - stroke.from;
    float share = foot_share(seen.segment);
    vec2 on_map = share_on_map(seen.segment, share);
    float growth = (seen.phases.to - seen.phases.from) * on_map.y / max(length(way), 1e-9);
    float period = 1.0 / max(abs(growth), 1e-9);
    float phase = mix(seen.phases.from, seen.phases.to, on_map.x), taken = 0.0;
    vec2 foot = mix(stroke.from, stroke.to, share);
    uvec2 mask = no_samples;
    int at = seen.phases.first_mark;
    do {
        vec4 mark = texelFetch(line_patterns, at);
        mask |= mark_mask(mark, stroke, phase, foot, period);
        taken += 0.5 * (mark.z + mark.w) * (mark.y - mark.x);
    } while (++at < seen.phases.end_mark);
    int count = int(clamp(taken, 0.0, 1.0) * float(sample_count) + 0.5);
    uvec2 first = uvec2(count >= 32 ? ~0u : (1u << count) - 1u, count >= 64 ? ~0u : count > 32 ? (1u << (count - 32)) - 1u : 0u);
    return period < 1.0 ? first : mask;
}

// A joint as wide as the pattern is at its place, in the gap between the bars.
uvec2 joint_mask(SeenSegment seen, LineLook look, float whole, bool at_end) {
    vec2 at = at_end ? seen.segment.to : seen.segment.from;
    float width = min(whole * look.reach, whole * width_at(seen.phases, at_end ? seen.phases.to : seen.phases.from));
    bool is_inner = at_end && !finishes(seen);
    bool is_corner = is_inner && corner_of(look.kind) != round_corner;
    uvec2 mask = no_samples;
    if (is_corner) mask = corner_mask(at, seen.direction, seen.outgoing, width, look.kind);
    else mask = disc_mask(at, width);
    mask &= is_inner ? wedge_mask(at, seen.direction, seen.outgoing) : beyond_line(at, at_end ? seen.direction : -seen.direction);
    return width > 0.0 && (is_inner || cap_of(look.kind) == round_cap) ? mask : no_samples;
}

uvec2 patterned_mask(SeenSegment seen, LineLook look, Stroke stroke, float whole, vec2 longer) {
    Stroke whole_stroke = stroke;
    whole_stroke.half_width = whole;
    uvec2 mask = bar_mask(stroke, longer) & marks_mask(seen, whole_stroke);
    mask |= joint_mask(seen, look, whole, true);
    if (begins(seen)) mask |= joint_mask(seen, look, whole, false);
    return mask;
}

#endif

uvec2 segment_mask(SeenSegment seen, LineLook look, float whole) {
    float half_width = whole * look.reach;
    Stroke stroke = Stroke(seen.segment.from, seen.segment.to, seen.direction, half_width);
    bool turns = (seen.flags & SEGMENT_TURNS) != 0u;
#ifdef JOINED
    bool joined = corner_of(look.kind) != round_corner, capped = cap_of(look.kind) == round_cap;
    float cap = cap_of(look.kind) == square_cap ? whole : 0.0;
    vec2 longer = vec2(begins(seen) ? cap : overlap, finishes(seen) ? cap : overlap);
#ifdef STYLED
    if (look.pattern != NO_PATTERN) return patterned_mask(seen, look, stroke, whole, longer);
#endif
    uvec2 mask = bar_mask(stroke, longer) | ends_mask(stroke, begins(seen) && capped, finishes(seen) ? capped : turns && !joined);
    if (joined && !finishes(seen)) {
        float near = half_width * joint_reach(look.kind) + half_diagonal;
        if (dot(stroke.to, stroke.to) < near * near) mask |= corner_mask(stroke.to, seen.direction, seen.outgoing, half_width, look.kind);
    }
    return mask;
#else
    vec2 longer = vec2(begins(seen) ? 0.0 : overlap, finishes(seen) ? 0.0 : overlap);
    return bar_mask(stroke, longer) | ends_mask(stroke, begins(seen), finishes(seen) || turns);
#endif
}

// The slot that is looked at, and the samples that it covers.
struct SampledSlot {
    uint slot;
    LineLook look;
    float half_width;  // of the whole line
    uvec2 covered;
    uvec2 taken;  // by bands of the same line that lie farther in
#ifdef SIDES
    float nearest[sample_count];  // segment of the ring
    uvec2 inside;
#endif
};

void begin_slot(inout SampledSlot slot, ScreenPlane plane, uint next) {
    LineLook look = look_of(next);
    uvec2 taken = no_samples;
#ifdef STYLED
    bool is_same_line = slot.slot != no_slot && line_of(next, look.kind) == line_of(slot.slot, slot.look.kind);
    if (is_same_line) taken = slot.taken | slot.covered;
#endif
    slot.slot = next;
    slot.look = look;
    slot.half_width = half_width_in_pixels(look, next, plane.pixels_per_metre);
    slot.covered = no_samples;
    slot.taken = taken;
#ifdef SIDES
    int i = 0;
    do {
        slot.nearest[i] = nothing_near;
    } while (++i < sample_count);
    slot.inside = no_samples;
#endif
}

void lay_under(inout Samples samples, SampledSlot slot) {
    uvec2 mask = slot.covered & ~slot.taken;
#ifdef SIDES
    if (!is_kept(true, slot.look.kind)) mask &= ~slot.inside;
    if (!is_kept(false, slot.look.kind)) mask &= slot.inside;
#endif
    if (!is_empty(mask) && slot.look.color.a > 0.0) lay_under(samples, mask, slot.look.color);
}

void add_segment(inout SampledSlot slot, SeenSegment seen) {
    if (!seen.is_on_ground) return;
    slot.covered |= segment_mask(seen, slot.look, slot.half_width);
#ifdef SIDES
    for (int i = 0; i < sample_count; ++i) {
        bvec2 aside = looked_aside(slot.nearest[i], seen, sample_offsets[i]);
        if (aside.x) slot.inside = (slot.inside & ~sample_if(true, i)) | sample_if(aside.y, i);
    }
#endif
}

vec4 composed(ScreenPlane plane, ivec2 range) {
    Samples samples = samples_of(all_samples);
    SampledSlot slot;
    slot.slot = no_slot;
    slot.look = no_look();
    slot.half_width = 0.0;
    slot.covered = slot.taken = no_samples;
#ifdef UNION
    begin_slot(slot, plane, 0u);
#endif
    int at = range.y - 1;
    bool ended = at < range.x;
    do {
        // On to the next segment that comes near the pixel. What a turn works out is lost when neighbouring pixels take more
        // turns (llvmpipe); only what is carried from turn to turn is there afterwards.
        bool near = false;
        do {
            int index = int(texelFetch(tile_list, max(at, 0)).r);
            ScreenSegment segment = on_screen(plane, texelFetch(segment_ends, index));
#ifndef UNION
            uint own_slot = texelFetch(segment_joints, index).z;
            if (own_slot != slot.slot && !ended) {
                lay_under(samples, slot);
                begin_slot(slot, plane, own_slot);
                ended = is_empty(samples.open);
            }
#endif
            float reach = slot.half_width;
#ifdef JOINED
            reach *= joint_reach(slot.look.kind);
#endif
            near = !ended && segment.seen && slot.half_width > 0.0;
#ifndef SIDES
            near = near && slot.covered != all_samples;
#endif
            near = near && distance_to(segment) < reach + half_diagonal;
            --at;
            ended = ended || (at < range.x && !near);
#ifdef UNION
            ended = ended || slot.covered == all_samples;
#endif
        } while (!near && !ended);
        if (near) {
            int index = int(texelFetch(tile_list, at + 1).r);
            add_segment(slot, seen_segment(plane, index, slot.look, slot.half_width));
            ended = at < range.x;
        }
    } while (!ended);
    lay_under(samples, slot);
    return samples.sum / float(sample_count);
}

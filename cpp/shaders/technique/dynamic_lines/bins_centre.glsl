// What covers the pixel's centre: colours over each other, or the topmost slot.
//
// The slots of a tile come from the topmost down. One is laid under what is there as soon as a segment of it covers the
// centre; with SIDES when all its segments have said on which side of the ring the centre lies.
#include "technique/dynamic_lines/line_point.glsl"

struct Centre {
    vec4 sum;
    uint topmost;
};

// The slot that is looked at, and what is known of it.
struct CentreSlot {
    uint slot;
    LineLook look;
    float half_width;  // of the whole line
    bool covered;
    bool taken;  // by a band of the same line that lies farther in
#ifdef SIDES
    float nearest;  // segment of the ring
    bool is_inside;
#endif
};

CentreSlot centre_slot(ScreenPlane plane, uint slot, CentreSlot before) {
    CentreSlot next = before;
    next.slot = slot;
    next.look = look_of(slot);
    next.half_width = half_width_in_pixels(next.look, slot, plane.pixels_per_metre);
    next.covered = false;
    next.taken = false;
#ifdef STYLED
    bool is_same_line = before.slot != no_slot && line_of(slot, next.look.kind) == line_of(before.slot, before.look.kind);
    next.taken = is_same_line && (before.taken || before.covered);
#endif
#ifdef SIDES
    next.nearest = nothing_near;
#endif
    return next;
}

bool is_shown(CentreSlot slot) {
    bool shown = slot.covered && !slot.taken && slot.look.color.a > 0.0;
#ifdef SIDES
    shown = shown && is_kept(slot.is_inside, slot.look.kind);
#endif
    return shown;
}

void lay_under(inout Centre centre, CentreSlot slot) {
    if (!is_shown(slot)) return;
    if (centre.topmost == no_slot) centre.topmost = slot.slot;
    float weight = (1.0 - centre.sum.a) * slot.look.color.a;
    centre.sum += weight * vec4(slot.look.color.rgb, 1.0);
}

// A corner is looked at from the segment that ends there.
bool is_hit(SeenSegment seen, LineLook look, float whole) {
    float share = foot_share(seen.segment);
    vec3 marks = vec3(1.0);
#ifdef STYLED
    if (look.pattern != NO_PATTERN) marks = widths_along(seen.phases, share_on_map(seen.segment, share).x);
#endif
    LinePart part = LinePart(seen.segment.from, seen.segment.to, seen.direction, seen.outgoing, begins(seen), finishes(seen),
                             (seen.flags & SEGMENT_TURNED) != 0u, (seen.flags & SEGMENT_TURNS) != 0u, marks);
    return decides(part, share) && covers(part, look, whole);
}

Centre composed(ScreenPlane plane, ivec2 range) {
    Centre centre = Centre(vec4(0.0), no_slot);
    CentreSlot slot;
    slot.slot = no_slot;
    slot.look = no_look();
    slot.half_width = 0.0;
    slot.covered = false;
    slot.taken = false;
#ifdef SIDES
    slot.nearest = nothing_near;
    slot.is_inside = false;
#endif
#ifdef UNION
    slot.look = look_of(0u);
    slot.half_width = half_width_in_pixels(slot.look, 0u, plane.pixels_per_metre);
#endif
    int at = range.y - 1;
    bool ended = at < range.x;
    do {
        // On to the next segment that comes near enough. What a turn works out is lost when neighbouring pixels take more
        // turns (llvmpipe); only what is carried from turn to turn is there afterwards.
        bool near = false;
        do {
            int index = int(texelFetch(tile_list, max(at, 0)).r);
            ScreenSegment segment = on_screen(plane, texelFetch(segment_ends, index));
#ifndef UNION
            uint own_slot = texelFetch(segment_joints, index).z;
            if (own_slot != slot.slot && !ended) {
#ifdef SIDES
                lay_under(centre, slot);
#endif
                slot = centre_slot(plane, own_slot, slot);
            }
#endif
            float reach = slot.half_width;
#ifdef JOINED
            reach *= joint_reach(slot.look.kind);
#endif
            near = !ended && segment.seen && takes_room(slot.look) && slot.half_width > 0.0;
#ifndef SIDES
            near = near && !slot.covered;
#endif
            near = near && distance_to(segment) <= reach;
            --at;
            ended = ended || (at < range.x && !near);
        } while (!near && !ended);
        if (near) {
            int index = int(texelFetch(tile_list, at + 1).r);
            SeenSegment seen = seen_segment(plane, index, slot.look, slot.half_width);
            bool hit = seen.is_on_ground && !slot.covered && is_hit(seen, slot.look, slot.half_width);
            slot.covered = slot.covered || hit;
#ifdef SIDES
            if (seen.is_on_ground) {
                bvec2 aside = looked_aside(slot.nearest, seen, vec2(0.0));
                slot.is_inside = aside.x ? aside.y : slot.is_inside;
            }
#else
            if (hit) lay_under(centre, slot);
#endif
            ended = at < range.x;
#ifdef IDS
            ended = ended || centre.topmost != no_slot;
#else
            ended = ended || centre.sum.a >= 0.999;
#endif
        }
    } while (!ended);
#ifdef SIDES
    lay_under(centre, slot);
#endif
    return centre;
}

// The features at one point, topmost first, until nothing shows behind.
#include "technique/loops/lists.glsl"
#include "technique/loops/primitives.glsl"

const uint no_slot = 0xFFFFFFFFu;

struct Found {
    vec4 sum;    // premultiplied
    uint seen;   // the topmost slot that shows
    float half_width;  // of the slot in hand
    uint slot;
    vec4 color;
    bool inside;
    bool done;
    int tested;
    int active_count;
};

// A slot's primitives may lie in several groups, which follow each other.
void settle(inout Found found) {
    if (found.inside && found.color.a > 0.0) {
        if (found.seen == no_slot) found.seen = found.slot;
        found.sum += (1.0 - found.sum.a) * vec4(found.color.rgb * found.color.a, found.color.a);
    }
    found.inside = false;
#if defined(TESTED) || defined(ACTIVE)
#elif defined(IDS)
    found.done = found.seen != no_slot;
#else
    found.done = found.sum.a >= 0.999;
#endif
}

void begin_slot(inout Found found, uint slot) {
    if (slot == found.slot) return;
    settle(found);
    uvec2 style = texelFetch(loops_styles, int(slot)).rg;
    found.slot = slot;
    found.color = unpackUnorm4x8(style.r);
    found.half_width = uintBitsToFloat(style.g);
}

// The next primitive of the group that is active; the others are passed over in a loop of their own, since a branch
// not taken costs as much in software as one that is.
struct Next {
    uint primitive;
#ifdef STROKES
    Drawn drawn;
#endif
    bool any;
};

Next next_active(inout int place, int end, bool is_fill, inout int tested) {
    Next next;
    next.any = false;
    do {
        next.primitive = word(place++);
        ++tested;
#ifdef FILLS
#ifdef STROKES
        if (is_fill) next.any = is_active_point(next.primitive);
#else
        next.any = is_active_point(next.primitive);
#endif
#endif
#ifdef STROKES
#ifdef FILLS
        if (!is_fill) {
#endif
            next.drawn = drawn_of(next.primitive);
            next.any = next.drawn.any;
#ifdef FILLS
        }
#endif
#endif
    } while (!next.any && place < end);
    return next;
}

void visit_group(inout Found found, int place, int end, ivec2 point) {
    bool is_fill = found.half_width == 0.0;
    do {
        Next next = next_active(place, end, is_fill, found.tested);
        if (next.any) {
            ++found.active_count;
#ifdef FILLS
            if (is_fill && triangle_holds(next.primitive, point)) found.inside = !found.inside;
#endif
#ifdef STROKES
            if (!is_fill && stroke_covers(next.drawn, found.half_width, point)) found.inside = true;
#endif
        }
    } while (place < end);
}

Found walk(ivec2 point) {
    Lists lists = lists_at(point);
    Found found = Found(vec4(0.0), no_slot, 0.0, no_slot, vec4(0.0), false, false, 0, 0);
    bool any = false;
    do {
        // The list whose next group lies topmost.
        uint least = no_slot;
        int place = 0;
        for (int i = 0; i < most_lists; ++i) {
            uint header = lists.at[i].next < lists.at[i].end ? word(lists.at[i].next) : no_slot;
            if (header < least) {
                least = header;
                place = lists.at[i].next;
            }
        }
        any = least != no_slot;
        if (any) {
            int end = place + 1 + int(least & GROUP_COUNT_MASK);
            for (int i = 0; i < most_lists; ++i)
                if (lists.at[i].next == place) lists.at[i].next = end;
            begin_slot(found, least >> GROUP_COUNT_BITS);
            if (!found.done) visit_group(found, place + 1, end, point);
        }
    } while (any && !found.done);
    if (!found.done) settle(found);
    return found;
}

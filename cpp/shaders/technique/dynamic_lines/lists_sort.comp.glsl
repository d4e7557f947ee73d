// Sorts the list of each pixel, topmost first (Zechmeister 2020, sections 3.3.3 and 4.3.3): a selection sort that moves
// what entries hold and not the entries, and that ends where nothing behind can show.
//
// A driver may end the loops of one run after so many turns in all: what is left is for the next run, which goes on
// where `sorted` says.
//
// SIDES   inset and offset outlines, of which all entries together tell whether they are shown
#include "technique/dynamic_lines/items.glsl"
#include "technique/dynamic_lines/line_entry.glsl"
#include "technique/dynamic_lines/lists_buffers.glsl"

layout(std430, binding = 5) buffer Sorted {
    uint sorted[];  // entries of each list that are in their place, or all_sorted
};

uniform uint most_turns;

const uint all_sorted = 0xFFFFFFFFu;
const float opaque = 0.999;

struct Composite {
    uint line;    // of the entry before; a line counts once
    float clear;  // how much of what lies behind shows through
};

void add_entry(inout Composite composite, uint at) {
    uvec2 entry = entries[at];
#ifdef SIDES
    if (asides[at] != shown_anyway) return;
#endif
    if (!is_same_line(entry.x, composite.line)) composite.clear *= 1.0 - unpackUnorm4x8(entry.y).a;
    composite.line = entry.x;
}

// The topmost entry from here on comes to stand here.
void select(uint here, uint count) {
    uvec2 first = entries[here];
    uvec2 best = first;
    uint best_at = here, other = here, left = count;
    do {
        uvec2 entry = entries[other];
        if (entry.x > best.x) {
            best = entry;
            best_at = other;
        }
        other = next[other];
    } while (--left > 0u && other != list_end);
    entries[best_at] = first;
    entries[here] = best;
#ifdef SIDES
    uint aside = asides[here];
    asides[here] = asides[best_at];
    asides[best_at] = aside;
#endif
}

void main() {
    uint list = this_item();
    if (list >= item_count) return;
    uint count = counts[list], done = sorted[list];
    if (count < 2u || done == all_sorted) return;
    Composite composite = Composite(list_end, 1.0);
    uint here = heads[list], turns = done, passed = 0u;
    if (done > 0u) {
        do {
            add_entry(composite, here);
            here = next[here];
        } while (++passed < done);
    }
    bool finished;
    do {
        select(here, count - done);
        add_entry(composite, here);
        turns += count - done + 1u;
        here = next[here];
        ++done;
        finished = done + 1u >= count || composite.clear <= 1.0 - opaque;
    } while (!finished && turns + count - done < most_turns);
    sorted[list] = finished ? all_sorted : done;
    if (!finished) is_unsorted = 1u;
}

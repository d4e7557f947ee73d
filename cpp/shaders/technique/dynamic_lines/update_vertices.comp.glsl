// The vertices that a view keeps: a bit each, 32 an invocation, and how many those are.
#include "technique/dynamic_lines/items.glsl"
#include "technique/dynamic_lines/update_simplify.glsl"

layout(std430, binding = 0) writeonly buffer Masks {
    uint masks[];
};
layout(std430, binding = 1) writeonly buffer Counts {
    uint counts[];
};

uniform uint vertex_count;

void main() {
    uint word = this_item();
    if (word >= item_count) return;
    uint first = 32u * word;
    uint end = min(first + 32u, vertex_count);
    ScreenCell before = no_cell();
    if (first > 0u) before = screen_cell(vertex_at(first - 1u));
    uint mask = 0u, bit = 1u, vertex = first;
    do {
        ScreenCell here = screen_cell(vertex_at(vertex));
        if (here.line != before.line) mask |= bit >> 1;  // the one before ends its line
        if (!same_cell(before, here)) mask |= bit;
        before = here;
        bit <<= 1;
    } while (++vertex < end);
    uint line_after = end < vertex_count ? vertex_at(end).line : NO_VERTEX;
    if (line_after != before.line) mask |= 1u << (end - 1u - first);
    masks[word] = mask;
    counts[word] = uint(bitCount(mask));
}

// The segments between kept vertices that may show: a bit each at the segment's first vertex, 32 an invocation.
#include "technique/dynamic_lines/items.glsl"
#include "technique/dynamic_lines/project.glsl"
#include "technique/dynamic_lines/update_view.glsl"

layout(std430, binding = 0) writeonly buffer Masks {
    uint masks[];
};
layout(std430, binding = 1) writeonly buffer Counts {
    uint counts[];
};
layout(std430, binding = 2) readonly buffer Kept {
    uint kept[];
};

uniform uint kept_count;

void main() {
    uint word = this_item();
    if (word >= item_count) return;
    uint first = 32u * word;
    uint end = min(first + 32u, kept_count);
    MatchedVertex from = vertex_at(kept[first]);
    uint mask = 0u, bit = 1u, at = first;
    do {
        MatchedVertex to = vertex_at(kept[min(at + 1u, kept_count - 1u)]);
        bool is_segment = at + 1u < kept_count && to.line == from.line;
        if (is_segment && may_show(map_place(from), map_place(to))) mask |= bit;
        from = to;
        bit <<= 1;
    } while (++at < end);
    masks[word] = mask;
    counts[word] = uint(bitCount(mask));
}

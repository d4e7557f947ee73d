// Writes the vertices that a view keeps behind each other: the bits that are set, from the prefix sum of their counts.
#include "technique/dynamic_lines/items.glsl"

layout(std430, binding = 0) readonly buffer Masks {
    uint masks[];
};
layout(std430, binding = 1) readonly buffer Offsets {
    uint offsets[];
};
layout(std430, binding = 2) writeonly buffer Kept {
    uint kept[];
};

void main() {
    uint word = this_item();
    if (word >= item_count) return;
    uint mask = masks[word];
    if (mask == 0u) return;
    uint at = offsets[word];
    do {
        kept[at++] = 32u * word + uint(findLSB(mask));
        mask &= mask - 1u;
    } while (mask != 0u);
}

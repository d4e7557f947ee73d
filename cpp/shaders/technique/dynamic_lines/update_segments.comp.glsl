// Writes the segments that may show behind each other, each with the vertices before and after it.
#include "technique/dynamic_lines/items.glsl"
#include "technique/dynamic_lines/line_vertices.glsl"

// Of vertices: the bits of those that are kept, and how many are before each word of them.
layout(std430, binding = 0) readonly buffer VertexMasks {
    uint vertex_masks[];
};
layout(std430, binding = 1) readonly buffer VertexOffsets {
    uint vertex_offsets[];
};
layout(std430, binding = 2) readonly buffer Kept {
    uint kept[];
};
// Of segments, by the place of their first vertex in `kept`.
layout(std430, binding = 3) readonly buffer Masks {
    uint masks[];
};
layout(std430, binding = 4) readonly buffer Offsets {
    uint offsets[];
};
layout(std430, binding = 5) writeonly buffer Segments {
    LineSegment segments[];  // from first_place on
};
uniform uint first_word;
uniform uint first_place;

// Where a vertex that is kept stands among those.
uint place_in_kept(uint vertex) {
    uint word = vertex >> 5;
    uint below = vertex_masks[word] & ((1u << (vertex & 31u)) - 1u);
    return vertex_offsets[word] + uint(bitCount(below));
}

LineSegment segment_at(uint at) {
    uint from = kept[at], to = kept[at + 1u];
    LineRecord line = line_at(vertex_at(from).line);
    uint first = place_in_kept(line.first), last = place_in_kept(line.first + line.count - 1u);
    bool is_first = at == first, is_last = at + 1u == last;
    // A closed line of which one segment is left is a dot.
    bool goes_round = (line.flags & LINE_CLOSED) != 0u && last > first + 1u;
    uint before = is_first ? last - 1u : at - 1u;
    uint after = is_last ? first + 1u : at + 2u;
    uint previous = is_first && !goes_round ? NO_VERTEX : kept[before];
    uint next = is_last && !goes_round ? NO_VERTEX : kept[after];
    return LineSegment(previous, from, to, next);
}

void main() {
    uint item = this_item();
    if (item >= item_count) return;
    uint word = first_word + item;
    uint mask = masks[word];
    if (mask == 0u) return;
    uint at = offsets[word] - first_place;
    do {
        segments[at++] = segment_at(32u * word + uint(findLSB(mask)));
        mask &= mask - 1u;
    } while (mask != 0u);
}

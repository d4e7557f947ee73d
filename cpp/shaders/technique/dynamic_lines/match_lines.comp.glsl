// Lines as their matched vertices count.
#include "technique/dynamic_lines/items.glsl"
#include "technique/dynamic_lines/line_buffers.h"

uniform usamplerBuffer source_lines;
uniform usamplerBuffer piece_offsets;

layout(std430, binding = 0) writeonly buffer Lines {
    LineRecord lines[];
};

void main() {
    uint index = this_item();
    if (index >= item_count) return;
    uvec4 source = texelFetch(source_lines, int(index));
    uint first = texelFetch(piece_offsets, int(source.x)).r;
    uint end = texelFetch(piece_offsets, int(source.x + source.y)).r;
    lines[this_record()] = LineRecord(first, end - first, source.z, source.w);
}

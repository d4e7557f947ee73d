// Vertices, lines and segments as they are read (line_buffers.h).
#include "technique/dynamic_lines/line_buffers.h"

uniform usamplerBuffer line_vertices;  // MatchedVertex
uniform usamplerBuffer line_records;

MatchedVertex vertex_at(uint index) {
    uvec4 texel = texelFetch(line_vertices, int(index));
    return MatchedVertex(ivec2(texel.xy), uintBitsToFloat(texel.z), texel.w);
}

LineRecord line_at(uint index) {
    uvec4 texel = texelFetch(line_records, int(index));
    return LineRecord(texel.x, texel.y, texel.z, texel.w);
}

// How many pieces a segment of a line is cut into (Zechmeister 2020, algorithm 3.1), in double precision: a pass that
// runs once, and whose results must not depend on where the origin lies.
#include "technique/dynamic_lines/line_buffers.h"

layout(std140, binding = 1) uniform MatchGrid {
    dvec4 grid;  // a place's column is x * grid.x + grid.y, its row y * grid.z + grid.w
    dvec4 steps;  // x: quantum; y: the longest piece, in quanta
};

uniform usamplerBuffer source_vertices;
uniform usamplerBuffer source_lines;

SourceVertex source_at(uint index) {
    uvec4 texel = texelFetch(source_vertices, int(index));
    return SourceVertex(ivec2(texel.xy), texel.z, texel.w);
}

LineRecord source_line(uint index) {
    uvec4 texel = texelFetch(source_lines, int(index));
    return LineRecord(texel.x, texel.y, texel.z, texel.w);
}

bool is_last(LineRecord line, uint vertex) {
    return vertex + 1u == line.first + line.count;
}

uint pieces_of(ivec2 from, ivec2 to) {
    dvec2 way = dvec2(to) - dvec2(from);
    double across = sqrt(way.x * way.x + way.y * way.y);
    return across > steps.y ? uint(floor(across / steps.y)) + 1u : 1u;
}

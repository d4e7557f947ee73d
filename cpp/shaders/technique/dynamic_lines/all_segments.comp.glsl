// Every segment of all lines: those before a vertex are the vertices before it, less one a line.
#include "technique/dynamic_lines/items.glsl"
#include "technique/dynamic_lines/line_vertices.glsl"

layout(std430, binding = 0) writeonly buffer Segments {
    LineSegment segments[];
};

uniform uint first_segment;  // that the bound part of the buffer begins with

void main() {
    uint vertex = this_item();
    if (vertex >= item_count) return;
    uint index = vertex_at(vertex).line;
    LineRecord line = line_at(index);
    uint last = line.first + line.count - 1u;
    if (vertex == last) return;
    bool closed = (line.flags & LINE_CLOSED) != 0u;
    uint previous = vertex > line.first ? vertex - 1u : closed ? last - 1u : NO_VERTEX;
    uint next = vertex + 1u < last ? vertex + 2u : closed ? line.first + 1u : NO_VERTEX;
    segments[vertex - index - first_segment] = LineSegment(previous, vertex, vertex + 1u, next);
}

// Of each source vertex, how many matched vertices begin with it: the pieces of its segment, or itself at a line's end.
#include "technique/dynamic_lines/items.glsl"
#include "technique/dynamic_lines/subdivision.glsl"

layout(std430, binding = 0) writeonly buffer Pieces {
    uint pieces[];
};

void main() {
    uint vertex = this_item();
    if (vertex >= item_count) return;
    SourceVertex source = source_at(vertex);
    uint count = 1u;
    if (!is_last(source_line(source.line), vertex)) count = pieces_of(source.place, source_at(vertex + 1u).place);
    pieces[this_record()] = count;
}

// Which vertices of a line a view can tell apart (Zechmeister 2020, algorithm 3.2, mended).
//
//     cells of the screen    | a b | c   | d e |      b and e fall into the cell of the vertex before them: a, c, d
//                            |     |     |   f |      are left, and f, where the line ends
//
// A line keeps its ends, so that none vanishes and none is joined to the next. Vertices that are not in front of the
// camera, or so far beside the picture that float32 counts no cells there, are kept: a cell of theirs says nothing.
#include "technique/dynamic_lines/project.glsl"

uniform float cells_per_pixel;  // 0: all vertices are kept

// Beyond, cells are counted with less than two bits behind the point.
const float farthest_cell = 2097152.0;

struct ScreenCell {
    ivec2 cell;
    uint line;
    bool is_known;
};

ScreenCell no_cell() {
    return ScreenCell(ivec2(0), NO_VERTEX, false);
}

ScreenCell screen_cell(MatchedVertex vertex) {
    vec4 clip = clip_from_base * vec4(ground_place(vertex), 1.0);
    vec2 place = clip.xy / clip.w * (0.5 * cells_per_pixel) * spacing.zw;
    bool is_known = clip.w > 0.0 && all(lessThan(abs(place), vec2(farthest_cell)));
    ivec2 cell = is_known ? ivec2(floor(place)) : ivec2(0);
    return ScreenCell(cell, vertex.line, is_known && cells_per_pixel > 0.0);
}

bool same_cell(ScreenCell a, ScreenCell b) {
    return a.is_known && b.is_known && a.line == b.line && a.cell == b.cell;
}

// A square for each block of tiles with anything in it. The tiles of a row follow each other in the list, so a row of a
// block is empty where its first place is its last.
#include "shared/view_block.h"
#include "technique/dynamic_lines/bins_layout.h"
#include "technique/dynamic_lines/tile_range.glsl"

uniform ivec2 drawn_size;
uniform ivec2 block_grid;

bool has_segments(ivec2 first, ivec2 end) {
    bool found = false;
    int row = first.y;
    do {
        int begin = row * tile_grid.x;
        found = found || range_of_tile(begin + first.x).x != range_of_tile(begin + end.x - 1).y;
    } while (++row < end.y);
    return found;
}

void main() {
    ivec2 block = ivec2(gl_InstanceID % block_grid.x, gl_InstanceID / block_grid.x);
    ivec2 first = BLOCK_TILES * block, end = min(first + BLOCK_TILES, tile_grid);
    ivec2 corner = TILE_SIDE * ivec2((gl_VertexID & 1) == 0 ? first.x : end.x, gl_VertexID < 2 ? first.y : end.y);
    vec2 place = 2.0 * vec2(corner - picture.xy) / vec2(drawn_size) - 1.0;
    gl_Position = has_segments(first, end) ? vec4(place, 0.5, 1.0) : vec4(-2.0, -2.0, 0.5, 1.0);
}

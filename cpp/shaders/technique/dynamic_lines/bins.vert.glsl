// A square for each tile of the screen with anything in it.
#include "shared/view_block.h"
#include "technique/dynamic_lines/bins_layout.h"
#include "technique/dynamic_lines/tile_range.glsl"

uniform ivec2 drawn_size;

flat out ivec2 tile_range;

void main() {
    ivec2 tile = ivec2(gl_InstanceID % tile_grid.x, gl_InstanceID / tile_grid.x);
    tile_range = range_of_tile(gl_InstanceID);
    ivec2 corner = TILE_SIDE * (tile + ivec2(gl_VertexID & 1, gl_VertexID >> 1)) - picture.xy;
    bool empty = tile_range.x == tile_range.y;
    gl_Position = empty ? vec4(-2.0, -2.0, 0.5, 1.0) : vec4(2.0 * vec2(corner) / vec2(drawn_size) - 1.0, 0.5, 1.0);
}

// The mesh of one terrain tile at one level of detail, and its seams.
//
// A tile is 64 x 64 quads of samples; level l steps over 2^l of them. Along a side whose neighbour is coarser, the
// vertices move onto the neighbour's: both tiles then have the same edge, and there is no crack to cover with
// skirts, which would give false map positions.
//
//     o---o---o---o===o-------o
//     |   |   |   |  /        |       the second and fourth vertex of the seam have moved down
//     o---o---o---o-/         |       onto the first and third
//     |   |   |   |/          |
//     o---o---o---o===o-------o
#include "shared/view_block.h"

const int tile_quads = 64;

uniform sampler2D heights;      // texel (column, row); missing samples are below missing_height
uniform ivec2 tile_sample;      // column, row of the tile's first sample
uniform int tile_level;
uniform ivec4 neighbour_levels;  // west, east, north, south

const float missing_height = -1e30;

int align(int index, int level) {
    return (index >> level) << level;
}

// The sample of a vertex given by column and row inside the tile, in steps of its level.
ivec2 mesh_sample(ivec2 vertex) {
    ivec2 local = vertex << tile_level;
    ivec2 moved = local;
    if (local.x == 0) moved.y = align(local.y, max(tile_level, neighbour_levels.x));
    if (local.x == tile_quads) moved.y = align(local.y, max(tile_level, neighbour_levels.y));
    if (local.y == 0) moved.x = align(local.x, max(tile_level, neighbour_levels.z));
    if (local.y == tile_quads) moved.x = align(local.x, max(tile_level, neighbour_levels.w));
    return min(tile_sample + moved, samples.xy - 1);
}

float sample_height(ivec2 sample_index) {
    return texelFetch(heights, sample_index, 0).r;
}

// A surface point relative to the base. The integer difference comes first: it is exact.
vec3 relative_to_base(ivec2 sample_index, float height) {
    vec2 steps = vec2(sample_index - base_sample.xy) - base_sample_fraction.xy;
    return vec3(steps.x * spacing.x, -steps.y * spacing.y, (height - base_sample_fraction.z) - base_sample_fraction.w);
}

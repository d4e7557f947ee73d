// The cell grid on the GPU: from map positions to cells, and the texels of a cell (cell_stream.h).
#include "shared/view_block.h"
#include "shared/position.glsl"
#include "technique/static_decals/cell_stream.h"

uniform usamplerBuffer cell_starts;
uniform usamplerBuffer cell_texels;
uniform usamplerBuffer decal_styles;  // colour bytes, half width in quanta
uniform int cell_shift;               // a cell is 2^cell_shift blocks
uniform float quanta_per_metre;
uniform ivec2 first_cell;             // counted from the position grid's origin
uniform ivec2 grid_size;
uniform int bucket_columns;
#ifdef ONE_WIDTH
uniform float line_scale;        // units per quantum
uniform float line_half_width2;  // squared, in units
#endif

struct CellPosition {
    ivec2 cell;
    vec2 local;  // quanta from the cell's lower left corner
};

// The last place in a cell that stays in it when COORDINATE_BIAS is added in float32.
const float last_in_cell = float(CELL_QUANTA) - 1.0 / 128.0;

CellPosition locate(Position position) {
    float block_size = base_offset.z;
    if (cell_shift >= 0) {
        ivec2 inside = position.block & ((1 << cell_shift) - 1);
        return CellPosition((position.block >> cell_shift) - first_cell,
                            min((vec2(inside) * block_size + position.offset) * quanta_per_metre, last_in_cell));
    }
    vec2 quanta = position.offset * quanta_per_metre;
    vec2 steps = floor(quanta / float(CELL_QUANTA));
    return CellPosition((position.block << -cell_shift) + ivec2(steps) - first_cell,
                        min(quanta - steps * float(CELL_QUANTA), last_in_cell));
}

// The texels of a cell: first and one past the last. Outside the grid there are none.
uvec2 cell_range(ivec2 cell) {
    if (any(lessThan(cell, ivec2(0))) || any(greaterThanEqual(cell, grid_size))) return uvec2(0u);
    ivec2 bucket = cell >> BUCKET_BITS;
    ivec2 low = cell & ((1 << BUCKET_BITS) - 1);
    int index = (bucket.y * bucket_columns + bucket.x) * BUCKET_CELLS + (low.x << BUCKET_BITS | low.y);
    return uvec2(texelFetch(cell_starts, index).r, texelFetch(cell_starts, index + 1).r);
}

struct Group {
    uint slot;
    bool is_line;
    float scale;        // units per quantum
    float half_width2;  // squared, in units
};

bool is_header(uvec2 texel) {
    return (texel.x & 0xFFFFu) == HEADER_MARK;
}

bool covers_corner(uvec2 header) {
    return (header.x & GROUP_COVERS) != 0u;
}

Group read_group(uvec2 header) {
    Group group;
    group.slot = header.y;
#if defined(LINES) && defined(RINGS)
    group.is_line = (header.x & GROUP_LINE) != 0u;
#elif defined(LINES)
    group.is_line = true;
#else
    group.is_line = false;
#endif
#if defined(LINES) && defined(ONE_WIDTH)
    group.scale = group.is_line ? line_scale : 1.0;
    group.half_width2 = line_half_width2;
#elif defined(LINES)
    group.scale = uintBitsToFloat((127u - (header.x >> GROUP_SCALE_SHIFT & GROUP_SCALE_MASK)) << 23);
    float half_width = uintBitsToFloat(texelFetch(decal_styles, int(header.y)).g) * group.scale;
    group.half_width2 = half_width * half_width;
#else
    group.scale = 1.0;
    group.half_width2 = 0.0;
#endif
    return group;
}

// Straight alpha.
vec4 color_of(uint slot) {
    return unpackUnorm4x8(texelFetch(decal_styles, int(slot)).r);
}

vec4 read_piece(uvec2 texel) {
    // By way of signed integers, whose conversion is one instruction.
    return vec4(ivec4(texel.x & 0xFFFFu, texel.x >> 16, texel.y & 0xFFFFu, texel.y >> 16));
}

// The height at which a ring piece crosses the cell's left border, or beyond every cell if it does not.
float border_crossing(vec4 piece) {
    bool starts_left = piece.x == float(COORDINATE_BIAS);
    bool ends_left = piece.z == float(COORDINATE_BIAS);
    return starts_left == ends_left ? 1e9 : starts_left ? piece.y : piece.w;
}

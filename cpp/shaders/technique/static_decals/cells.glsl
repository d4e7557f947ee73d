// The cell lists on the GPU: from map positions to cells, and the words of a list (cell_lists.h).
#include "shared/view_block.h"
#include "shared/position.glsl"
#include "technique/static_decals/cell_lists.h"
#include "technique/static_decals/looks.glsl"

uniform usamplerBuffer bucket_entries;
uniform usamplerBuffer cell_entries;
uniform ivec2 grid_size;              // in buckets
uniform int block_shift;              // a block of the position grid is 2^block_shift quanta
uniform ivec2 first_quantum;          // of the grid, counted from the position grid's origin, modulo 2^32
uniform ivec2 first_block;            // the same in blocks, where a block is less than a quantum
uniform float quanta_per_metre;

// A place on the lattice, counted from the grid's lower left corner.
struct LatticePosition {
    ivec2 quantum;
    vec2 fraction;
};

// Sky lies outside every grid.
LatticePosition on_lattice(Position position) {
    if (is_sky(position)) return LatticePosition(ivec2(-1), vec2(0.0));
    vec2 quanta = position.offset * quanta_per_metre;
    if (block_shift >= 0) {
        vec2 whole = floor(quanta);
        return LatticePosition((position.block << block_shift) + ivec2(whole) - first_quantum, quanta - whole);
    }
    ivec2 block = position.block - first_block;
    ivec2 inside = block & ((1 << -block_shift) - 1);
    return LatticePosition(block >> -block_shift, quanta + vec2(inside) * exp2(float(block_shift)));
}

struct Cell {
    int bits;     // 2^bits quanta wide
    ivec2 corner;
    uint entry;
};

// The cell at a place. Outside the grid, and where nothing is, its list is empty.
Cell cell_at(ivec2 quantum) {
    ivec2 bucket = quantum >> BUCKET_BITS;
    if (any(lessThan(bucket, ivec2(0))) || any(greaterThanEqual(bucket, grid_size)))
        return Cell(BUCKET_BITS, bucket << BUCKET_BITS, EMPTY_LIST);
    uint entry = texelFetch(bucket_entries, bucket.y * grid_size.x + bucket.x).r;
    int level = int(entry & ((1u << LEVEL_BITS) - 1u));
    int bits = BUCKET_BITS - level;
    ivec2 inside = (quantum & (BUCKET_QUANTA - 1)) >> bits;
    int cell = int(entry >> LEVEL_BITS) + (inside.y << level | inside.x);
    return Cell(bits, quantum >> bits << bits, texelFetch(cell_entries, cell).r);
}

// What is added to coordinates in a cell of this size.
float bias_of(int cell_bits) {
    return float((COORDINATE_SPAN - (1 << cell_bits)) >> 1);
}

bool is_header(uint word) {
    return word >= HEADER;
}

bool starts_edge(uint word) {
    return (word & MOVE) != 0u;
}

vec2 point_of(uint word) {
    return vec2(ivec2(word & COORDINATE_MASK, word >> COORDINATE_BITS & COORDINATE_MASK));
}

bool is_line(uint header) {
#if defined(LINES) && defined(RINGS)
    return (header & LINE) != 0u;
#elif defined(LINES)
    return true;
#else
    return false;
#endif
}

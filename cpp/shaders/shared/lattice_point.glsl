// Places on the lattice that vectors were rounded to (lattice.h), in quanta.
#include "shared/position.glsl"

uniform ivec2 first_block;  // the lattice begins at its corner
uniform int block_shift;    // a block is 2^block_shift quanta
uniform float quanta_per_metre;

// Beyond every lattice, and little enough for sums of 32 bits.
const float farthest = 1e9;

// The lattice point nearest to a position, moved by some metres.
ivec2 lattice_point(Position position, vec2 moved) {
    ivec2 block = position.block - first_block;
    vec2 offset = position.offset + moved;
    if (block_shift < 0) {
        ivec2 rest = block & ((1 << -block_shift) - 1);
        offset += vec2(rest) * base_offset.z;
        block >>= -block_shift;
    } else {
        block <<= block_shift;
    }
    return block + ivec2(clamp(roundEven(offset * quanta_per_metre), -farthest, farthest));
}

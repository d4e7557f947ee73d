// Map positions in the G-buffer: an integer block and an offset in metres inside it (position_grid.h).

const int sky_block = -2147483647 - 1;

struct Position {
    ivec2 block;
    vec2 offset;
};

uvec4 pack_position(Position position) {
    return uvec4(position.block, floatBitsToUint(position.offset));
}

Position unpack_position(uvec4 texel) {
    return Position(ivec2(texel.xy), uintBitsToFloat(texel.zw));
}

bool is_sky(Position position) {
    return position.block.x == sky_block;
}

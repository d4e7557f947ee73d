// The virtual texture: 2^20 texels a side over the terrain, in levels of tiles.
//
//     level 0     one tile of 256 texels          level l     2^l tiles a side         level 12     4096 tiles
//
// Its side is a power of two in metres, and its corner a block of the position grid: so a place is a whole texel of the
// finest level and a fraction, and a whole texel of any other level by a shift. Vectors lie on a lattice of 2^30 steps
// over the same square.
#pragma once

#include <cmath>
#include <cstdint>

#include "decalgl/core/position_grid.h"

namespace decalgl::clipmap {

constexpr int tile_bits = 8;
constexpr int tile_texels = 1 << tile_bits;
constexpr int finest_level = 12;
constexpr int level_count = finest_level + 1;
constexpr int lattice_bits = 30;

struct VirtualTexture {
    double left = 0.0;  // metres
    double bottom = 0.0;
    double side = 1.0;
    int32_t first_block_x = 0;
    int32_t first_block_y = 0;

    static VirtualTexture over(const Bounds& bounds, const PositionGrid& positions) {
        VirtualTexture texture;
        const auto block_of = [&](double at, double origin) {
            return static_cast<int32_t>(std::floor((at - origin) / positions.block_size));
        };
        texture.first_block_x = block_of(bounds.min_x, positions.origin_x);
        texture.first_block_y = block_of(bounds.min_y, positions.origin_y);
        texture.left = positions.origin_x + texture.first_block_x * positions.block_size;
        texture.bottom = positions.origin_y + texture.first_block_y * positions.block_size;
        const double extent = std::max(bounds.max_x - texture.left, bounds.max_y - texture.bottom);
        texture.side = std::exp2(std::floor(std::log2(extent)) + 1.0);
        return texture;
    }

    double quantum() const { return std::ldexp(side, -lattice_bits); }
    // Metres of a texel.
    double texel(int level) const { return std::ldexp(side, -(level + tile_bits)); }
};

struct Tile {
    int level;
    int x;
    int y;

    bool operator<(const Tile& other) const {
        return level != other.level ? level < other.level : y != other.y ? y < other.y : x < other.x;
    }
    bool operator==(const Tile& other) const { return level == other.level && x == other.x && y == other.y; }
};

}  // namespace decalgl::clipmap

// Tiles of a heightfield and how far each of their levels of detail is off.
//
// Level l takes every 2^l-th sample. Triangulations of neighbouring levels nest, so the largest vertical
// distance between a coarse surface and the full one is found at the samples.
#pragma once

#include <array>

#include "decalgl/core/shared_array.h"
#include "decalgl/terrain/heightfield.h"

namespace decalgl {

constexpr int32_t tile_quads = 64;
constexpr int tile_levels = 7;  // 64 quads down to 1

struct TerrainTile {
    int32_t column = 0;  // first sample
    int32_t row = 0;
    float lowest = 0.0F;
    float highest = 0.0F;
    std::array<float, tile_levels> error{};  // metres; infinite where the level would move the rim of a hole
};
static_assert(sizeof(TerrainTile) == 44, "saved as it is");

struct TerrainTiles {
    int32_t columns = 0;
    int32_t rows = 0;
    bool has_holes = false;
    SharedArray<TerrainTile> tiles;  // row by row; lowest > highest marks one without a triangle

    static TerrainTiles over(const Heightfield& heightfield, unsigned threads);
};

}  // namespace decalgl

// Levels of detail of a static index: what the map looks like from so far that a pixel spans many cells.
//
// The finest level is a raster of LEVEL_TEXELS x LEVEL_TEXELS texels a bucket. Each holds the mean over its area of the
// features' composite, as the shader would draw it: premultiplied colour and coverage, from 16 samples. Coarser
// levels are means of four, so a line of any width keeps its coverage, and neighbours that share a border leave
// no gap. Only filtered pictures of pixels that span some texels are drawn from levels.
#pragma once

#include <cstdint>
#include <vector>

#include "decalgl/core/large_array.h"
#include "technique/static_decals/prepared_decals.h"

namespace decalgl {

struct LevelRaster {
    int32_t width = 0;
    int32_t height = 0;
    LargeArray<uint8_t> texels;  // R, G, B, A, premultiplied; the lowest row first
};

// On all cores; the same bytes on any number of them.
LevelRaster draw_finest_level(const PreparedDecals& decals);
// The part of it that lies in one bucket, LEVEL_TEXELS a side.
std::vector<uint8_t> draw_level_of_bucket(const PreparedDecals& decals, uint32_t bucket);

}  // namespace decalgl

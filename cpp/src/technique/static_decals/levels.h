// Levels of detail of a static index: what the map looks like from so far that a pixel spans many cells.
//
// The finest level is a raster of LEVEL_TEXELS x LEVEL_TEXELS texels a bucket, or of fewer where no pixel needs as many. Each
// holds the mean over its area of the features' composite, as the shader would draw it: premultiplied colour and
// coverage, from 16 samples. Coarser levels are means of four, so a line of any width keeps its coverage, and neighbours
// that share a border leave no gap. Only filtered pictures of pixels that span some texels are drawn from levels.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "decalgl/core/large_array.h"
#include "technique/static_decals/level_samples.h"
#include "technique/static_decals/prepared_decals.h"

namespace decalgl {

struct LevelRaster {
    int32_t width = 0;
    int32_t height = 0;
    LargeArray<uint8_t> texels;  // R, G, B, A, premultiplied; the lowest row first
};

// Draws the finest level of an index in any looks. What the samples see is kept, so that only the first one, other widths and
// what was edited take a walk through the lists.
class LevelPainter {
public:
    // `texels`: along a bucket's side.
    explicit LevelPainter(int texels, const MemoryAccount& memory = MemoryAccount())
        : texels_(texels), memory_(memory) {}

    // On all cores; the same bytes on any number of them, and whatever was kept.
    LevelRaster draw(const PreparedDecals& look);
    // The part of it that lies in one bucket.
    std::vector<uint8_t> draw_bucket(const PreparedDecals& look, uint32_t bucket);

private:
    struct Kept {
        uint32_t entry;  // of the bucket then
        bool is_kept;
        BucketSamples samples;
    };

    void take_shapes_of(const PreparedDecals& look);
    const BucketSamples& samples_of(const PreparedDecals& look, uint32_t bucket, BucketSampler& sampler);
    void charge_kept();

    int texels_;
    MemoryAccount memory_;
    MemoryCharge charge_;
    std::shared_ptr<const ShapeToken> shapes_;
    std::vector<Kept> kept_;
};

}  // namespace decalgl

// The lowest and highest ground under a rectangle of the map, from a pyramid of both.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "decalgl/terrain/heightfield.h"

namespace decalgl::network {

struct HeightRange {
    float lowest;
    float highest;  // below the lowest where there is no sample
};

class HeightRanges {
public:
    HeightRanges(const Heightfield& terrain, unsigned threads);

    // Over the samples whose triangles reach into the rectangle.
    HeightRange over(const Bounds& rectangle) const;
    float lowest() const { return terrain_.lowest(); }
    float highest() const { return terrain_.highest(); }
    // Height that 16 bits count in steps of.
    double step() const;
    // lowest | highest << 16, in steps rounded outwards.
    uint32_t packed(const HeightRange& range) const;

private:
    struct Level {
        int32_t rows, columns;
        std::vector<HeightRange> ranges;
    };
    HeightRange at(size_t level, int32_t row, int32_t column) const;

    Heightfield terrain_;  // shares its samples
    std::vector<Level> levels_;  // level k: of 2^(k+1) samples a side
};

}  // namespace decalgl::network

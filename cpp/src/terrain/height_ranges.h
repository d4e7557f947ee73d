// The lowest and highest ground under a rectangle of the map, from a pyramid of both.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>

#include "decalgl/core/memory.h"
#include "decalgl/terrain/heightfield.h"
#include "terrain/pyramid.h"

namespace decalgl {

struct HeightRange {
    float lowest = std::numeric_limits<float>::infinity();
    float highest = -std::numeric_limits<float>::infinity();

    bool empty() const { return lowest > highest; }  // no ground
    void add(const HeightRange& other) {
        lowest = std::min(lowest, other.lowest);
        highest = std::max(highest, other.highest);
    }
};

class HeightRanges {
public:
    // Charged to the account as `name`. Throws Error(memory).
    HeightRanges(const Heightfield& terrain, unsigned threads, const MemoryAccount& memory,
                 const std::string& name);

    // Of the samples whose triangles reach into the rectangle; empty beyond the terrain.
    HeightRange over(const Bounds& rectangle) const;
    float lowest() const { return terrain_.lowest(); }
    float highest() const { return terrain_.highest(); }
    // Height that 16 bits count in steps of.
    double step() const;
    // lowest | highest << 16, in steps rounded outwards.
    uint32_t packed(const HeightRange& range) const;

private:
    HeightRange of_samples(const BlockBox& box) const;

    Heightfield terrain_;  // shares its samples
    MemoryCharge charge_;
    Pyramid<HeightRange> blocks_;  // of 2 x 2 samples
};

}  // namespace decalgl

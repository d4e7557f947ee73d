// The lowest and the highest ground under a box of the map: a pyramid over the quads of the terrain.
#pragma once

#include <vector>

#include "decalgl/core/memory.h"
#include "decalgl/terrain/heightfield.h"
#include "technique/shadow_volumes/lattice.h"

namespace decalgl::volume {

struct HeightRange {
    float low = std::numeric_limits<float>::infinity();
    float high = -std::numeric_limits<float>::infinity();

    bool empty() const { return low > high; }  // no ground
    void add(HeightRange other) {
        low = std::min(low, other.low);
        high = std::max(high, other.high);
    }
};

class HeightRanges {
public:
    HeightRanges(const Heightfield& terrain, const Lattice& lattice, const MemoryAccount& memory);

    HeightRange under(const LatticeBox& box) const;

private:
    struct Level {
        int columns = 0;
        int rows = 0;
        std::vector<HeightRange> quads;
    };

    void add_finest();
    void add_coarser();

    const Heightfield& terrain_;
    Lattice lattice_;
    std::vector<Level> levels_;
    MemoryCharge charge_;
};

}  // namespace decalgl::volume

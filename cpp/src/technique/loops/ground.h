// The ground below a piece of the map: how high and low it is, and how much longer than on the map it makes
// a way. A pyramid over the heightfield, each block with the extremes of its quads.
#pragma once

#include "decalgl/terrain/heightfield.h"
#include "technique/loops/lattice.h"
#include "terrain/pyramid.h"

namespace decalgl::loops {

struct GroundRange {
    float lowest;
    float highest;
    float steepest;  // squared slope

    void add(const GroundRange& other) {
        lowest = std::min(lowest, other.lowest);
        highest = std::max(highest, other.highest);
        steepest = std::max(steepest, other.steepest);
    }
};

class Ground {
public:
    Ground(const Heightfield& terrain, const Lattice& lattice, unsigned threads);

    // Of what lies below a box, or where it lies outside of what is nearest to it.
    GroundRange below(const LatticeBox& box) const;
    GroundRange everywhere() const { return all_; }

private:
    Lattice lattice_;
    double x0_, y0_, dx_, dy_;  // of a block
    Pyramid<GroundRange> blocks_;
    GroundRange all_;
};

}  // namespace decalgl::loops

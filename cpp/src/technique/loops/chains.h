// Chains: the parts of all features as runs of lattice points, cut to the lattice.
//
// A ring that lies far out in part is cut as a polygon, a line into the pieces that are left of it. Equal
// points in a row are one.
#pragma once

#include <vector>

#include "decalgl/core/large_array.h"
#include "decalgl/vector/layer.h"
#include "technique/loops/lattice.h"

namespace decalgl::loops {

struct Chains {
    LargeArray<LatticePoint> points;
    std::vector<uint64_t> offsets = {0};  // chain c owns points offsets[c] .. offsets[c + 1]
    std::vector<uint32_t> features;       // of each chain, in all layers: sorted
    std::vector<uint8_t> closed;          // whether it goes back to its first point

    size_t count() const { return features.size(); }
    size_t size_of(size_t chain) const { return static_cast<size_t>(offsets[chain + 1] - offsets[chain]); }
    Span<const LatticePoint> points_of(size_t chain) const {
        return Span<const LatticePoint>(points).subspan(static_cast<size_t>(offsets[chain]), size_of(chain));
    }
};

// Appends the chains of a layer, whose features are counted from `first_feature`.
void add_chains(const Layer& layer, uint32_t first_feature, const Lattice& lattice, unsigned threads,
                Chains& chains);

}  // namespace decalgl::loops

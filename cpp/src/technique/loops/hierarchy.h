// Everything about some layers that levels of detail need: arcs, their refinement, and when vertices are active.
#pragma once

#include "decalgl/core/progress.h"
#include "technique/loops/activation.h"

namespace decalgl::loops {

struct Hierarchy {
    Lattice lattice;
    GroundRange heights;  // of all the ground
    std::vector<uint32_t> first_features;  // of each layer, and how many there are in all
    std::vector<uint32_t> chain_features;  // of each chain
    Arcs arcs;
    Refinement refinement;
    LargeArray<Activation> activations;  // of each point
    uint64_t vertices = 0;               // of the input, as far as it is held
    uint64_t needs = 0;                  // dependencies between vertices

    double error_of(uint32_t point) const;  // metres
};

// `reach`: half the width of the widest line, metres.
Hierarchy build_hierarchy(Span<const Layer> layers, const Bounds& bounds, const PositionGrid& positions,
                          const Heightfield& terrain, double reach, const LoopsOptions& options, unsigned threads,
                          Progress& progress);

// The features of a layer as they are where the tolerance is the same all over the map: what a vertex adds
// that is off by no more than this, in metres, is left out. Rings of fewer than three vertices are left out too.
Features simplified(const Hierarchy& hierarchy, size_t layer, FeatureKind kind, double tolerance);

}  // namespace decalgl::loops

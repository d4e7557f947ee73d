// Lines and rings on the lattice, in the order in which they are drawn.
//
// A part keeps its vertices as a chain, so that neighbouring segments share them. One that leaves the lattice
// is cut, segment by segment, and becomes pairs of vertices:
//
//     chain   0--1--2--3      segments 0-1 1-2 2-3, and 3-0 for a ring
//     pairs   0--1  2--3      segments 0-1 2-3
//
// Edges of rings left and right of the lattice are moved onto its borders, so that the rings stay closed.
#pragma once

#include <cstdint>
#include <vector>

#include "decalgl/core/large_array.h"
#include "decalgl/core/memory.h"
#include "decalgl/technique/technique.h"
#include "technique/static_bvh/lattice.h"

namespace decalgl::bvh {

struct LatticePart {
    uint32_t slot;  // in the group, topmost first
    bool is_first;  // of its feature
    bool is_pairs;
    uint32_t first_vertex;
    uint32_t vertex_count;
};

// The part that a vertex lies in; the first one for a vertex before all parts.
size_t part_of_vertex(const std::vector<LatticePart>& parts, size_t vertex);

struct LatticeParts {
    LargeArray<LatticePoint> vertices;
    std::vector<LatticePart> parts;
};

// Which features a group draws, topmost first; places within the input's layers.
using Slots = std::vector<FeatureReference>;

// The vertices are charged to `charge` and the list of parts to `working`. Throws Error(memory).
LatticeParts to_lattice(const TechniqueInput& input, Span<const FeatureReference> slots,
                        const Lattice& lattice, MemoryCharge& charge, MemoryCharge& working);

}  // namespace decalgl::bvh

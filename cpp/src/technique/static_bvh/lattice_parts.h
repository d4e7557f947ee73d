// Rings on the lattice, in the order in which they are drawn.
//
// A ring keeps its vertices as a chain, so that neighbouring edges share them. One that leaves the lattice is
// cut, edge by edge, and becomes pairs of vertices:
//
//     chain   0--1--2--3      edges 0-1 1-2 2-3 3-0
//     pairs   0--1  2--3      edges 0-1 2-3
//
// Edges left and right of the lattice are moved onto its borders, so that the rings stay closed.
#pragma once

#include <cstdint>
#include <vector>

#include "decalgl/core/large_array.h"
#include "decalgl/core/memory.h"
#include "decalgl/technique/technique.h"
#include "technique/static_bvh/lattice.h"

namespace decalgl::bvh {

struct LatticePart {
    uint32_t polygon;  // in the group, topmost first
    bool is_first;     // of its polygon
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

// The rings of the polygons, topmost first, which go by their places within the input's layers. The vertices are
// charged to `charge` and the list of parts to `working`. Throws Error(memory).
LatticeParts to_lattice(const TechniqueInput& input, Span<const FeatureReference> polygons,
                        const Lattice& lattice, MemoryCharge& charge, MemoryCharge& working);

}  // namespace decalgl::bvh

// Noding of T-junctions: a chain that passes a vertex of another one goes through it from then on.
//
//     ───────────────         ───────●───────
//            │          ─▶           │            as near as rounding may have moved things: two quanta
//            │                       │
//
// So neighbours share whole runs of vertices, which are then simplified once. Lines that cross without a
// vertex go on crossing.
#pragma once

#include <vector>

#include "technique/loops/chains.h"
#include "technique/loops/locations.h"

namespace decalgl::loops {

struct NodedChains {
    LargeArray<uint32_t> locations;
    std::vector<uint64_t> offsets;

    Span<const uint32_t> of(size_t chain) const {
        return Span<const uint32_t>(locations)
            .subspan(static_cast<size_t>(offsets[chain]), static_cast<size_t>(offsets[chain + 1] - offsets[chain]));
    }
};

// `numbers`: the location of each point of the chains.
NodedChains node_junctions(const Chains& chains, const Locations& locations, Span<const uint32_t> numbers,
                           unsigned threads);

}  // namespace decalgl::loops

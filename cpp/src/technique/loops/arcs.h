// Arcs: the runs of vertices between junctions, each once, however many features share it.
//
//     ─────●───────●─────     A junction is a vertex that is passed in more than one way: the end of a line, the
//       A  │   B   │          place where borders meet. It is never removed. What lies between two of them has
//          └───────┘          one set of neighbours, so it is simplified once and stays the border of all.
//
// The junctions of a ring form a polygon of their own, its frame: its triangles are always drawn, and the
// rest is refinement of the arcs. A ring without junctions is one arc that begins and ends at its lowest vertex,
// and has no frame. The arithmetic of fills is modulo 2, so directions do not count.
#pragma once

#include <vector>

#include "decalgl/core/shared_array.h"
#include "technique/loops/noding.h"

namespace decalgl::loops {

enum class ArcKind : uint8_t {
    open,   // between two junctions
    ring,   // a whole ring, from its lowest vertex to the same
    frame,  // junctions of a ring, from the first to the same: its vertices stay
};

// Lists of arcs, in arrays that grow while they are made or in others that stay as they are.
template <typename Arrays>
struct ArcTable {
    typename Arrays::template Large<LatticePoint> points;  // arc after arc, with both ends
    typename Arrays::template Small<uint32_t> offsets;
    typename Arrays::template Small<ArcKind> kinds;

    // The arcs of each feature: those that bound its inside, and those that its stroke follows.
    typename Arrays::template Small<uint64_t> fill_offsets, stroke_offsets;
    typename Arrays::template Small<uint32_t> fill_arcs, stroke_arcs;

    size_t count() const { return kinds.size(); }
    uint32_t begin(size_t arc) const { return offsets[arc]; }
    uint32_t end(size_t arc) const { return offsets[arc + 1]; }
    uint32_t size_of(size_t arc) const { return end(arc) - begin(arc); }
    Span<const LatticePoint> points_of(size_t arc) const {
        return Span<const LatticePoint>(points).subspan(begin(arc), size_of(arc));
    }
    Span<const uint32_t> fill_of(size_t feature) const { return of(feature, fill_offsets, fill_arcs); }
    Span<const uint32_t> stroke_of(size_t feature) const { return of(feature, stroke_offsets, stroke_arcs); }

private:
    static Span<const uint32_t> of(size_t feature, Span<const uint64_t> begins, Span<const uint32_t> arcs) {
        const auto begin = static_cast<size_t>(begins[feature]);
        return arcs.subspan(begin, static_cast<size_t>(begins[feature + 1]) - begin);
    }
};

struct GrowingArrays {
    template <typename T>
    using Large = LargeArray<T>;
    template <typename T>
    using Small = std::vector<T>;
};
struct SharedArrays {
    template <typename T>
    using Large = SharedArray<T>;
    template <typename T>
    using Small = SharedArray<T>;
};

// As they are made, with what only preparing needs.
struct Arcs : ArcTable<GrowingArrays> {
    Arcs() { offsets = {0}; }

    LargeArray<uint32_t> locations;  // of the points
    // The arcs that a chain goes along, twice their number, and one more where it goes backwards.
    std::vector<uint64_t> chain_offsets;
    std::vector<uint32_t> chain_arcs;
};

// What views need of them.
using KeptArcs = ArcTable<SharedArrays>;
KeptArcs kept(Arcs&& arcs);

// What passes through a location: where it is more than one thing, a junction.
std::vector<uint8_t> find_junctions(const Chains& chains, const NodedChains& noded, size_t locations,
                                    unsigned threads);

// `features`: how many there are in all layers.
Arcs make_arcs(const Chains& chains, const NodedChains& noded, const Locations& locations, size_t features,
               unsigned threads);

}  // namespace decalgl::loops

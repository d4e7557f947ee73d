// The index of a view: the edges between active vertices, in cells over the ground that is seen (cells_layout.h).
//
//     arcs ─▶ active_arcs ─▶ edges of all slots ─▶ columns of buckets ─▶ buckets ─▶ cells
//                            cut between columns    cut between rows      bucket_cells.h
//
// A view that simplifies by ten has a tenth of the edges, and they are all that is drawn: nothing is judged pixel by
// pixel. So this index is made anew for each view, and takes the time that it saves only where much is active.
#pragma once

#include "technique/loops/active_arcs.h"
#include "technique/loops/bucket_cells.h"

namespace decalgl::loops {

struct ViewCells {
    LatticePoint corner{};  // of the first bucket
    int bucket_bits = 0;
    int columns = 0;  // of buckets; 0: nothing is seen
    int rows = 0;
    uint64_t active = 0;  // edges, before they are cut
    uint64_t cells = 0;
    CellLists lists;  // all of them, the first texel an empty list

    // Colours are no part of cells, which so serve for other ones too, and while features are hidden. Not where some
    // are to be seen that were not, or that lay hidden below others.
    bool serve(const Slots& slots) const;
    Slots made_for;
    std::vector<uint32_t> hiders;  // slots that are to stay opaque, sorted
};

// Throws Error(memory) where there is more than a shader can read.
ViewCells make_cells(const KeptArcs& arcs, const ActiveArcs& active, const Slots& slots,
                     const LatticeBox& box, unsigned threads);

}  // namespace decalgl::loops

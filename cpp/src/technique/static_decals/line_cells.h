// Lines into the cells of a bucket: a segment goes into each cell that its stroke may touch.
//
// Ends that come from cutting a segment where 15 bits end lie outside the stroke's reach of the cell, so they
// never show.
#pragma once

#include <cstdint>

#include "decalgl/core/span.h"
#include "technique/static_decals/cell_list_builder.h"

namespace decalgl {

class LineCells {
public:
    explicit LineCells(CellListBuilder& lists) : lists_(&lists) {}

    // Begins a line in the bucket that `lists` is at. `half_width` in quanta.
    void begin(uint32_t slot, float half_width);

    // First all covered cells of a line, then its edges, which those do without. Points that follow each
    // other, counted from the bucket's corner; one alone is a dot.
    void mark_covered_cells(Span<const LatticePoint> points);
    void add_edges(Span<const LatticePoint> points);

private:
    void add_edge(LatticePoint a, LatticePoint b, int64_t column, int64_t row);

    CellListBuilder* lists_;
    SquareRange cells_{};
    uint32_t slot_ = 0;
    double half_width_ = 0.0;  // quanta
    int64_t reach_ = 0;        // half width, rounded up
    int scale_ = 0;
    bool covers_cells_ = false;
};

}  // namespace decalgl

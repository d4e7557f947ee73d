// Rings into cells: edges are cut at cell borders, and cells without a piece are known whole.
//
// What is inside is decided from a cell's lower left corner: walk up the left border to the pixel's height,
// then right to the pixel, and count what is crossed.
//
//        +---------------------+      crossings on the left border:
//        |        __/          |          pieces that start there, below the pixel
//        o------/---> pixel    |      crossings of the row:
//        |    _/               |          pieces left of the pixel
//        +__/------------------+
//      corner
//
// Every edge is cut in its canonical direction (left to right), the cuts are rounded onto the lattice, and
// both cells at a border use the same cut. So two polygons that share a border have the same pieces, and a
// point belongs to exactly one of them. A corner's own state follows from the crossings of its column below
// it, which is what `covers` spans carry. The border between cells belongs to the right and upper one.
#pragma once

#include <cstdint>
#include <vector>

#include "decalgl/core/span.h"
#include "technique/static_decals/cell_records.h"

namespace decalgl {

class RingCells {
public:
    explicit RingCells(CellRecords& records) : records_(&records) {}

    // Adds one ring of the current feature, closing it if it is open. `coordinates`: x, y of its vertices.
    void add_ring(Span<const double> coordinates);

    // Ends the feature: marks the cells whose lower left corner is inside.
    void finish_feature();

private:
    void add_edge(LatticePoint a, LatticePoint b);
    void add_column_piece(int32_t column, LatticePoint a, LatticePoint b);
    void add_cell_piece(int32_t column, int32_t row, LatticePoint a, LatticePoint b);
    void add_crossing(int32_t column, int32_t row);

    CellRecords* records_;
    std::vector<uint32_t> crossings_;  // column << 16 | (row + 1); row -1 is everything below the grid
};

}  // namespace decalgl

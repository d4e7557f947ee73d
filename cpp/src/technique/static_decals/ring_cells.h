// Rings into the cells of a bucket.
//
// What is inside is decided from a cell's lower left corner: walk up the left border to the pixel's height,
// then right to the pixel, and count what is crossed.
//
//        +---------------------+      crossings on the left border:
//        |        __/          |          edges that start there, below the pixel
//        o------/---> pixel    |      crossings of the row:
//        |    _/               |          edges left of the pixel
//        +__/------------------+
//      corner
//
// The state of each corner follows from that of the bucket's own corner:
//
//     +-------+-------+-------+
//     |       |       |   \   |       along the bucket's lower border: edges that start there
//     o-------o-------o----\--o       change all corners to their right
//     |    /  |       |     \ |
//     |   /   |       |      \|       up a column: edges that leave its left border change
//     o--/----o-------o-------o       all corners above
//   known  change  change
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "technique/static_decals/cell_list_builder.h"

namespace decalgl {

class RingCells {
public:
    explicit RingCells(CellListBuilder& lists) : lists_(&lists) {}

    // Begins a polygon in the bucket that `lists` is at.
    void begin(uint32_t slot);

    // Adds an edge in the ring's direction. Points are counted from the bucket's corner.
    void add_edge(LatticePoint from, LatticePoint to);

    // Ends the polygon: marks the cells whose corner is inside.
    void finish(bool bucket_corner_inside);

    // The same for a polygon that cuts the next decal off, which is in the `touched` cells alone. Says in which
    // of the bucket's cells that decal may show.
    void begin_clip(uint32_t slot, const CellMask& touched);
    CellMask finish_clip(bool bucket_corner_inside, bool is_offset);

private:
    struct Piece {
        int64_t column, row;
        LatticePoint from, to;
    };

    void follow_lowest_row(const Piece& piece);
    void add_piece(const Piece& piece);

    CellListBuilder* lists_;
    SquareRange cells_{};
    // Calls on_inside(cell) for each cell whose corner is inside.
    template <typename OnInside>
    void for_each_inside(bool bucket_corner_inside, OnInside on_inside) const;

    uint32_t slot_ = 0;
    uint32_t flags_ = 0;
    const CellMask* touched_ = nullptr;  // of a clip
    std::vector<Piece> pieces_;
    std::array<uint64_t, 1 << FINEST_LEVEL> crossed_rows_{};  // of each column's left border; a bit a row
    uint64_t changed_columns_ = 0;                            // corners of the lowest row; a bit a column
    uint64_t crossed_columns_ = 0;                            // those with crossed rows
};

}  // namespace decalgl

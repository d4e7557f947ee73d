// The decal grid: which cells a segment or a node reaches into.
//
// Zechmeister 2020, sections 3.2.1 and 4.2.1: a regular grid over the common box of all decals. Segments are
// widened to quadrilaterals, taken to the cells of their box, and kept where quadrilateral and cell overlap.
// For a convex outline that is exact row by row: the part of it that lies in a row of cells reaches from one
// x to another.
//
//     +-----+-----+-----+-----+
//     |     |     |    /\     |      row 1: cells 2 and 3
//     |     |     |  /    \   |
//     +-----+-----+/-----/+---+
//     |     |   / |    /|     |      row 0: cells 1 and 2
//     |     | /   |  /  |     |
//     +-----+-\---+/----+-----+
#pragma once

#include <array>
#include <cstdint>

#include "technique/static_bvh/lattice.h"

namespace decalgl::bvh {

// A convex outline, corner by corner: a segment with its width, mitred or not.
struct Quadrilateral {
    std::array<double, 4> x;
    std::array<double, 4> y;
};

// Pixels are rounded to the lattice, and so is the half width in float32.
constexpr double rounding = 1.0;

struct CellRange {
    int32_t first;
    int32_t last;
};

struct DecalGrid {
    LatticeBox box;
    int32_t columns = 0;
    int32_t rows = 0;
    int32_t cell_width = 1;  // quanta
    int32_t cell_height = 1;

    // `cells` along each side, or fewer where the box has fewer points.
    static DecalGrid over(const LatticeBox& box, int32_t cells);

    uint32_t cell_count() const { return static_cast<uint32_t>(columns) * static_cast<uint32_t>(rows); }
    uint32_t cell(int32_t column, int32_t row) const {
        return static_cast<uint32_t>(column) + static_cast<uint32_t>(columns) * static_cast<uint32_t>(row);
    }
    LatticeBox cell_box(uint32_t cell) const;
    uint32_t cell_at(LatticePoint p) const {
        return cell((p.x - box.min_x) / cell_width, (p.y - box.min_y) / cell_height);
    }

    // Of a box that meets the grid's.
    CellRange columns_of(const LatticeBox& inner) const;
    CellRange rows_of(const LatticeBox& inner) const;

    // What the outline reaches in a row of cells; first > last where that is nothing.
    CellRange columns_in_row(const Quadrilateral& outline, int32_t row) const;

    // Calls on_cell(cell) for each cell that the outline overlaps; `candidates` is a box around it.
    template <typename OnCell>
    void for_each_cell(const Quadrilateral& outline, const LatticeBox& candidates, OnCell on_cell) const {
        const LatticeBox inner = common(candidates, box);
        if (inner.empty())
            return;
        const CellRange up = rows_of(inner);
        const CellRange across = columns_of(inner);
        const bool in_one_cell = up.first == up.last && across.first == across.last && box.holds(candidates);
        for (int32_t row = up.first; row <= up.last; ++row) {
            CellRange reached = across;
            if (!in_one_cell) {
                const CellRange exact = columns_in_row(outline, row);
                reached = {std::max(across.first, exact.first), std::min(across.last, exact.last)};
            }
            for (int32_t column = reached.first; column <= reached.last; ++column)
                on_cell(cell(column, row));
        }
    }
};

}  // namespace decalgl::bvh

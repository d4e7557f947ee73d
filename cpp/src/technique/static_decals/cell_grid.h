// The regular grid of cells over the terrain, and the lattice on which all vertices lie.
//
// Based on the decal grid of Zechmeister 2020, section 3.2.1. Ours differs in size (a power of two in metres,
// so that cells, lattice and the scene's position grid nest) and in what a cell holds (cell_stream.h).
#pragma once

#include <cmath>
#include <cstdint>

#include "decalgl/core/position_grid.h"
#include "technique/static_decals/cell_stream.h"

namespace decalgl {

struct CellGrid {
    PositionGrid positions;
    double cell_size = 1.0;    // metres, a power of two
    double quantum = 1.0;      // metres, cell_size / CELL_QUANTA
    int64_t first_cell_x = 0;  // of cell (0, 0), counted from the position grid's origin
    int64_t first_cell_y = 0;
    int32_t columns = 0;
    int32_t rows = 0;
    int32_t bucket_columns = 0;
    int32_t bucket_rows = 0;

    // A grid over `bounds` with between `resolution` / 2 and `resolution` cells along its longer side.
    static CellGrid over(const Bounds& bounds, const PositionGrid& positions, int32_t resolution);

    double left() const { return positions.origin_x + static_cast<double>(first_cell_x) * cell_size; }
    double bottom() const { return positions.origin_y + static_cast<double>(first_cell_y) * cell_size; }

    uint32_t bucket_count() const { return static_cast<uint32_t>(bucket_columns * bucket_rows); }
    uint32_t cell_count() const { return bucket_count() * BUCKET_CELLS; }

    uint32_t cell_index(int32_t column, int32_t row) const {
        const int32_t bucket = (row >> BUCKET_BITS) * bucket_columns + (column >> BUCKET_BITS);
        const int32_t low = (1 << BUCKET_BITS) - 1;
        return static_cast<uint32_t>(bucket) * BUCKET_CELLS +
               static_cast<uint32_t>(((column & low) << BUCKET_BITS) | (row & low));
    }
};

struct LatticePoint {
    int64_t x = 0;
    int64_t y = 0;
};

inline bool operator==(LatticePoint a, LatticePoint b) {
    return a.x == b.x && a.y == b.y;
}

// From map positions to the lattice, counted from the grid's lower left corner.
class Lattice {
public:
    explicit Lattice(const CellGrid& grid)
        : left_(grid.left()), bottom_(grid.bottom()), quanta_per_metre_(1.0 / grid.quantum) {}

    LatticePoint nearest(double x, double y) const {
        return {std::lrint((x - left_) * quanta_per_metre_), std::lrint((y - bottom_) * quanta_per_metre_)};
    }

private:
    double left_;
    double bottom_;
    double quanta_per_metre_;  // a power of two: multiplying by it is exact
};

}  // namespace decalgl

// The grid of buckets over the terrain, and the lattice on which all vertices lie.
//
// Based on the decal grid of Zechmeister 2020, section 3.2.1. Ours has two levels: buckets are squares whose side is a
// power of two in metres, so that buckets, lattice and the scene's position grid nest; and each bucket is cut
// into as many cells as its content asks for (cell_lists.h). So lists are short where the map is dense, and
// nothing is spent where it is empty.
#pragma once

#include <cmath>
#include <cstdint>

#include "decalgl/core/position_grid.h"
#include "technique/static_decals/cell_lists.h"

namespace decalgl {

struct BucketGrid {
    PositionGrid positions;
    double bucket_size = 1.0;    // metres, a power of two
    double quantum = 1.0;        // metres, bucket_size / BUCKET_QUANTA
    int64_t first_bucket_x = 0;  // of bucket (0, 0), counted from the position grid's origin
    int64_t first_bucket_y = 0;
    int32_t columns = 0;
    int32_t rows = 0;

    // A grid over `bounds` with between `resolution` / 2 and `resolution` buckets along its longer side.
    static BucketGrid over(const Bounds& bounds, const PositionGrid& positions, int32_t resolution);

    double left() const { return positions.origin_x + static_cast<double>(first_bucket_x) * bucket_size; }
    double bottom() const { return positions.origin_y + static_cast<double>(first_bucket_y) * bucket_size; }
    uint32_t bucket_count() const { return static_cast<uint32_t>(columns) * static_cast<uint32_t>(rows); }
    uint32_t bucket_index(int64_t column, int64_t row) const {
        return static_cast<uint32_t>(row * columns + column);
    }
};

// In quanta from the grid's lower left corner.
struct LatticePoint {
    int64_t x = 0;
    int64_t y = 0;
};

inline bool operator==(LatticePoint a, LatticePoint b) {
    return a.x == b.x && a.y == b.y;
}

inline double length_of(LatticePoint a, LatticePoint b) {
    return std::hypot(static_cast<double>(b.x - a.x), static_cast<double>(b.y - a.y));
}

class Lattice {
public:
    explicit Lattice(const BucketGrid& grid)
        : left_(grid.left()), bottom_(grid.bottom()), quanta_per_metre_(1.0 / grid.quantum) {}

    LatticePoint nearest(const double* xy) const {
        return {std::lrint((xy[0] - left_) * quanta_per_metre_),
                std::lrint((xy[1] - bottom_) * quanta_per_metre_)};
    }

private:
    double left_;
    double bottom_;
    double quanta_per_metre_;  // a power of two: multiplying by it is exact
};

// A rectangle of squares of 2^bits quanta each, buckets or cells: where edges are cut.
struct SquareRange {
    int bits;
    int64_t first_column, first_row;
    int64_t last_column, last_row;

    int64_t border(int64_t index) const { return index << bits; }
};

constexpr int cell_bits(int level) {
    return BUCKET_BITS - level;
}

constexpr int32_t cell_quanta(int level) {
    return 1 << cell_bits(level);
}

// What is added to coordinates in a cell, so that the cell lies in the middle of what 15 bits reach.
constexpr int32_t cell_bias(int level) {
    return level < COARSEST_LEVEL ? 0 : (COORDINATE_SPAN - cell_quanta(level)) / 2;
}

// Lines with a larger radius are held in units of 2^line_scale quanta.
inline int line_scale(float half_width_in_quanta) {
    int exponent = 0;
    std::frexp(half_width_in_quanta * (1.0F / MAX_RADIUS), &exponent);
    return exponent > 0 ? exponent : 0;
}

}  // namespace decalgl

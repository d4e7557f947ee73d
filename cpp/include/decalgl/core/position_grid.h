// The position grid: how a map position is held without losing digits.
//
// A position is an integer block and an offset in metres inside that block. The origin is a multiple of
// every power of two up to the scene's extent, so blocks, the cells of an index and its lattice all nest
// without remainder, and an offset in float32 is good to 2 micrometres whatever the coordinates are.
//
//     |<------------- span: a power of two, at least the scene's extent ------------->|
//     origin      block size: a power of two, at most 32 m
#pragma once

namespace decalgl {

struct Bounds {
    double min_x = 0.0;
    double min_y = 0.0;
    double max_x = 0.0;
    double max_y = 0.0;
};

struct PositionGrid {
    double origin_x = 0.0;
    double origin_y = 0.0;
    double span = 1.0;
    double block_size = 1.0;

    static PositionGrid around(const Bounds& bounds);
};

}  // namespace decalgl

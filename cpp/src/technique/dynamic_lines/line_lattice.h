// The lattice that the places of lines lie on (line_buffers.h).
#pragma once

#include "decalgl/core/position_grid.h"
#include "technique/dynamic_lines/line_buffers.h"

namespace decalgl {

// Pixels that the ground under a line may be seen from where a pixel's plane has it (ground_reach.glsl), beyond what is asked
// of the terrain's level of detail.
constexpr double ground_slack = 0.25;

constexpr int32_t lattice_reach = 1 << 30;  // places lie nearer to the origin

struct LineLattice {
    double origin_x = 0.0;
    double origin_y = 0.0;
    double quantum = 1.0;

    // Around a terrain, with as much room on each side as half of it is long.
    static LineLattice over(const Bounds& bounds);

    // Of points within the box alone.
    ivec2 place(double x, double y) const;
    double x_of(ivec2 place) const { return origin_x + place.x * quantum; }
    double y_of(ivec2 place) const { return origin_y + place.y * quantum; }
    Bounds box() const;
};

}  // namespace decalgl

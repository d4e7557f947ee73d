// Activations: where and by how much a vertex counts. One texel each.
//
// A vertex is active where its error is greater than the least tolerance anywhere in its region: a disc
// around its proxy, from the lowest to the highest ground there. Regions of parents hold those of their children and
// of whatever needs them, and errors are no smaller: "saturated". So whatever the tolerance is, and however
// it changes over the map, an active vertex has active parents. Vertices that need each other share all of it.
//
//     proxy x, y     error | radius     lowest | highest
//      quanta         half floats       shares of the ground's range
//
// The paper saturates the greatest distance of a vertex to its descendants by its maximum alone (section 3). That
// does not keep parents active: the disc has to hold the child's disc, and not only its centre. Figure 11 takes
// 16 bytes for this, and so does a texel here, with heights.
#pragma once

#include "technique/loops/dependencies.h"
#include "technique/loops/ground.h"

namespace decalgl::loops {

// Lengths in half floats are quanta times this: the greatest fits.
constexpr double length_scale = 1.0 / 32768.0;

struct Activation {
    int32_t x;
    int32_t y;
    uint32_t error_and_radius;
    uint32_t lowest_and_highest;
};
static_assert(sizeof(Activation) == 16, "an RGBA32 texel");

// Of every point; ends of arcs and vertices of frames are always active.
LargeArray<Activation> saturate(const Arcs& arcs, const Refinement& refinement, const Dependencies& dependencies,
                                const Ground& ground, unsigned threads);

}  // namespace decalgl::loops

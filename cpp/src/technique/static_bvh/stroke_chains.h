// Strokes on the lattice, in the order in which they are drawn: vertices in chains, and segments between them.
//
//     a line of four vertices     0--1--2--3      segments 0-1 1-2 2-3
//     a closed line, a ring       0--1--2--0      segments 0-1 1-2 2-0
//     a line of one vertex        0               segment 0-0
//
// Vertices that are equal on the lattice and follow each other are one. Where a stroke leaves the lattice, each
// of its segments is cut and becomes a chain. With guards (bvh_layout.h) the vertices before and after a
// segment are next to its own. Long segments of strokes with a pattern are divided, so that float32 tells how
// far along one a point lies.
#pragma once

#include "technique/static_bvh/cell_objects.h"

namespace decalgl::bvh {

// A decal of the group with the quanta that it may reach from its centre line.
struct StrokeSlot {
    DecalView decal;
    uint32_t slot;
    double half_width;
};

// Lays the chains of strokes, given topmost first, into the group's vertices and owners, and lists their
// segments.
void lay_chains(const TechniqueInput& input, Span<const StrokeSlot> strokes, const Lattice& lattice,
                GroupBuild& group, MemoryCharge& charge, WorkingArray<Segment>& segments);

}  // namespace decalgl::bvh

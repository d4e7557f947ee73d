// A network as an attributed point cloud: nodes and the segments between them (Trapp et al. 2015, section 5.1).
//
//     nodes          o───────o───────o      a place is one node, whichever lines meet there
//     segments           •       •          points, of which a geometry shader makes boxes
//
// Nodes lie on the lattice of the position grid: an integer block, and so many quanta inside it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "decalgl/core/large_array.h"
#include "decalgl/technique/technique.h"
#include "technique/distance_field/network_layout.h"
#include "terrain/height_ranges.h"

namespace decalgl::network {

struct Lattice {
    double origin_x = 0.0;
    double origin_y = 0.0;
    double quantum = 1.0;
    int block_shift = 0;  // quanta in a block are 2^block_shift

    static Lattice of(const PositionGrid& positions, const Bounds& bounds, double reach);
};

struct Node {
    int32_t x = 0;
    int32_t y = 0;
    uint32_t marks = 0;  // grade and clearance

    uint32_t grade() const { return marks & NODE_GRADE_MASK; }
};

struct Segment {
    uint32_t a = 0;
    uint32_t b = 0;
    uint32_t slot = 0;     // feature in the pass
    uint32_t heights = 0;  // lowest, highest ground
    float start = 0.0F;    // metres along the line at a
    uint32_t ends = 0;
};
static_assert(sizeof(Node) == 12 && sizeof(Segment) == 24, "as the shaders read them");

struct Network {
    Lattice lattice;
    LargeArray<Node> nodes;
    LargeArray<Segment> segments;

    std::array<double, 2> place(uint32_t node) const {
        return {lattice.origin_x + nodes[node].x * lattice.quantum,
                lattice.origin_y + nodes[node].y * lattice.quantum};
    }
    uint64_t bytes() const { return nodes.size() * sizeof(Node) + segments.size() * sizeof(Segment); }
};

// The segments of all features that come within `reach` metres of the bounds; slots count the features of all
// layers. Throws Error(memory), Error(cancelled).
Network build_network(const TechniqueInput& input, double reach, Progress& progress);

// Writes which ground each segment, widened by `reach`, lies over.
void set_heights(Network& network, const HeightRanges& ranges, double reach);

}  // namespace decalgl::network

// Quad-trees of rings (Zechmeister 2020, sections 3.2.1 and 4.2.1).
//
// The root is the ring's box. A node with more than `leaf_capacity` edges is cut into four, down to
// `depth_limit`; the cut follows the box, so nodes are as oblong as the ring. A leaf without edges is inside
// or outside. Another one keeps the rows that each of its edges takes there, and closing edges along its left
// border:
//
//     +-----------+-----+-----+
//     |           |     |     |       a partial leaf      +-----------+
//     |  outside  +---_-+-----+                           #      .    |   # closing edge: its rows are inside
//     |         __|_-'|#|#####|       edges 1 and 2       #     2 .   |     from the border on
//     +-----+-.'--+---+-+-----+       take these rows     #        .  |
//     |     |/    |   inside  |                           |  .        |   inside = an odd number of edges own
//     |    /|     |###########|                           | 1 .       |     the point's row and cross it at
//     +-----+-----+-----------+                           +-----------+     or left of the point
//
// Children are boxes of lattice points that touch without sharing any, and what an edge means for a box is
// decided exactly (ring_edge.h). So no child is enlarged, and clipping an edge to its rows moves nothing,
// where the thesis expands the nodes and rounds the cuts.
//
// All trees grow together, level by level: a level is one queue of nodes and one list of their edges, and
// both are worked off in pieces of even size. So one ring of millions of edges is built on all cores, as are
// millions of rings.
#pragma once

#include "technique/static_bvh/cell_objects.h"
#include "technique/static_bvh/ring_edge.h"

namespace decalgl::bvh {

// What a tree begins with: its box, and its edges in a row.
struct Ring {
    LatticeBox box;
    uint32_t first_edge;
    uint32_t edge_count;
};

// The root of ring i is node i. Boxes, links and edges are charged to `charge`.
QuadTrees grow_quad_trees(const TechniqueInput& input, const LargeArray<LatticePoint>& vertices,
                          const LargeArray<Edge>& edges, const std::vector<Ring>& rings, MemoryCharge& charge,
                          const Stage& stage);

// The boxes of a node's four children: lower left, lower right, upper left, upper right.
std::array<LatticeBox, 4> quarters(const LatticeBox& box);

}  // namespace decalgl::bvh

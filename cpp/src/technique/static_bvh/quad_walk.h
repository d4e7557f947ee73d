// Walks down quad-trees on the CPU.
#pragma once

#include <algorithm>

#include "technique/static_bvh/prepared_bvh.h"
#include "technique/static_bvh/ring_edge.h"

namespace decalgl::bvh {

// Whether a ring holds a point, of which the node's box need not.
inline bool holds(const DecalGroup& group, uint32_t node, LatticePoint point) {
    const QuadTreesOf<GrownArray>& quads = group.quads;
    if (!quads.boxes[node].holds(point))
        return false;
    while (quads.links[node].kind() == QUAD_INTERNAL) {
        // The first child ends where the others begin.
        const LatticeBox& low = quads.boxes[quads.links[node].first];
        node = quads.links[node].first + (point.x > low.max_x ? 1 : 0) + (point.y > low.max_y ? 2 : 0);
    }
    const QuadLink leaf = quads.links[node];
    if (leaf.kind() != QUAD_PARTIAL)
        return leaf.kind() == QUAD_INSIDE;
    bool inside = false;
    for (uint32_t i = leaf.first; i < leaf.first + leaf.count(); ++i) {
        const LeafEdge& edge = quads.edges[i];
        if (point.y < edge.first_row || point.y >= edge.end_row)
            continue;
        inside ^=
            edge.a == CLOSING_EDGE ||
            RingEdge(group.ring_vertices[edge.a], group.ring_vertices[edge.b]).crossing(point.y) <= point.x;
    }
    return inside;
}

inline bool holds(const DecalGroup& group, const Exterior& exterior, LatticePoint point) {
    bool inside = exterior.subtree != NO_SUBTREE && holds(group, exterior.subtree, point);
    for (uint32_t i = 0; i < exterior.interior_count; ++i)
        inside ^= holds(group, group.interiors[exterior.first_interior + i], point);
    return inside;
}

// The most nodes and edges that a point of a box looks at below a node.
inline uint64_t longest_way(const QuadTreesOf<GrownArray>& quads, uint32_t node, const LatticeBox& box) {
    if (!quads.boxes[node].meets(box))
        return 1;
    const QuadLink link = quads.links[node];
    if (link.kind() != QUAD_INTERNAL)
        return 1 + (link.kind() == QUAD_PARTIAL ? link.count() : 0);
    uint64_t longest = 0;
    for (uint32_t child = link.first; child < link.first + 4; ++child)
        longest = std::max(longest, longest_way(quads, child, box));
    return 1 + longest;
}

}  // namespace decalgl::bvh

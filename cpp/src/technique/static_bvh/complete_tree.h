// Complete binary trees of boxes over the objects of a cell, after Zechmeister 2020, sections 4.2.1 and
// 4.4.1.
//
// Empty leaves on the right make their number a power of two, so nodes need no links (equations 4.5 to 4.7).
// Here the root is node 1 and the children of k are 2k and 2k + 1, which turns "up to the first node with a
// right sibling, then to that" into a shift:
//
//                1                     binary:  k       = 1011   a right child of a right child
//          2           3                        strip 1s =  10
//       4     5     6     7                     + 1      =  11    the next node to the right
//      8 9  10 11  12 .  . .
//
// Here five objects are at leaves 8 to 12; the empty ones up to 15 are not stored.
#pragma once

#include <cstdint>

#include "decalgl/core/span.h"
#include "technique/static_bvh/lattice.h"

namespace decalgl::bvh {

// The first leaf, which is as many as there are leaves; 0 without objects.
inline uint32_t first_leaf(uint32_t objects) {
    if (objects == 0)
        return 0;
    uint32_t leaf = 1;
    while (leaf < objects)
        leaf *= 2;
    return leaf;
}

// Nodes that are stored: up to the last object's leaf.
inline uint32_t stored_nodes(uint32_t objects) {
    return objects == 0 ? 0 : first_leaf(objects) - 1 + objects;
}

// The node after the subtree of `node`; 0 after the last.
inline uint32_t next_right(uint32_t node) {
    while ((node & 1) != 0)
        node >>= 1;
    return node == 0 ? 0 : node + 1;
}

// Node k is nodes[k - 1]. `nodes` has room for stored_nodes(objects.size()).
inline void fill_tree(Span<const LatticeBox> objects, LatticeBox* nodes) {
    const auto count = static_cast<uint32_t>(objects.size());
    const uint32_t stored = stored_nodes(count);
    const uint32_t leaf = first_leaf(count);
    for (uint32_t i = 0; i < count; ++i)
        nodes[leaf - 1 + i] = objects[i];
    for (uint32_t node = leaf; node-- > 1;) {
        LatticeBox box;
        for (uint32_t child = 2 * node; child <= std::min(2 * node + 1, stored); ++child)
            box.add(nodes[child - 1]);
        nodes[node - 1] = box;
    }
}

// Visits the objects in whose boxes `reached` holds, in order, as algorithm 3.5 finds them. Stops where
// `on_object` returns false. Returns the number of nodes looked at.
template <typename Reached, typename OnObject>
uint32_t traverse(const LatticeBox* nodes, uint32_t objects, Reached reached, OnObject on_object) {
    const uint32_t leaf = first_leaf(objects);
    uint32_t visited = 0;
    for (uint32_t node = objects > 0 ? 1 : 0; node != 0 && node < leaf + objects; ++visited) {
        const bool inside = reached(nodes[node - 1]);
        if (inside && node < leaf) {
            node *= 2;
            continue;
        }
        if (inside && !on_object(node - leaf))
            return visited + 1;
        node = next_right(node);
    }
    return visited;
}

}  // namespace decalgl::bvh

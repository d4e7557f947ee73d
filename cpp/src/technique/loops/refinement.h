// Refinement trees: what each vertex adds to its arc, told by the order of removal (section 4.1).
//
//               s            s is the splitter of the base a-b: the vertices next to it when it goes. Its triangle
//             /   \          is added to or taken from what the base bounds. In the tree, s lies below that one of
//           a ----- b        a and b that goes first.
//
// The tree is the Cartesian tree of the times of removal, found with one stack. `left` and `right` are numbers
// of points, as everything here is.
#pragma once

#include "technique/loops/arcs.h"
#include "technique/loops/removal_orders.h"

namespace decalgl::loops {

constexpr uint32_t no_point = UINT32_MAX;

struct Refinement {
    LargeArray<uint32_t> left;     // the base's ends; of an arc's own ends no_point
    LargeArray<uint32_t> right;
    LargeArray<uint32_t> parents;  // no_point: a root, or an arc's own end
    LargeArray<uint32_t> order;    // arc by arc, the splitters, the first to go first; then no_point
    LargeArray<float> errors;      // quanta, never too small; of ends 0

    bool is_splitter(uint32_t point) const { return left[point] != no_point; }
    // Whether the edge between neighbours in an arc is a side of p's triangle, p being one of them.
    bool is_side(uint32_t p, uint32_t neighbour) const { return left[p] == neighbour || right[p] == neighbour; }
};

// Throws Error(input) for an order that a user's function made badly.
Refinement refine_arcs(const Arcs& arcs, const Lattice& lattice, const LoopsOptions& options, unsigned threads);

// A float that is not below the value.
float rounded_up(double value);

}  // namespace decalgl::loops

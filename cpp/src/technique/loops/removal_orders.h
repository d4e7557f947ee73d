// Orders of removal: which vertex of an arc goes first, and what its going is off by (section 4.3 of LOOPS).
//
// Any order will do that names each vertex but the two ends once. Errors are lengths in quanta.
//
//     douglas_peucker      the farthest vertex from a base stays longest; its distance is the error. It is the only
//                          order whose errors bound the distance between the simplified arc and the whole one
//     wang_mueller         bends, runs of vertices that turn the same way, go from the smallest on; inside a bend
//                          as above. A bend's error is the square root of its area
//     visvalingam_whyatt   the vertex of the smallest triangle goes first; the square root of its area
#pragma once

#include <vector>

#include "decalgl/technique/loops_options.h"
#include "technique/loops/lattice.h"

namespace decalgl::loops {

void order_douglas_peucker(Span<const LatticePoint> arc, std::vector<Removal>& order);
void order_wang_mueller(Span<const LatticePoint> arc, std::vector<Removal>& order);
void order_visvalingam_whyatt(Span<const LatticePoint> arc, std::vector<Removal>& order);

// By the function of a user. Throws Error(input) where it does not name each vertex between the ends once, with
// a finite error of zero or more.
void order_by_function(Span<const LatticePoint> arc, const Lattice& lattice, const RemovalFunction& function,
                       std::vector<Removal>& order);

}  // namespace decalgl::loops

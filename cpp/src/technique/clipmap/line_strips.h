// Joints of lines for triangle strips: Taibo et al. 2014, section 4.2 and algorithm 1.
//
//     ends                method 1: across the segment; of every segment, where joints have no method
//     wide angles         method 2: where the borders meet
//     angles below a      method 3a: both segments' own corners     3b: the inner borders' meeting point twice, unless
//     threshold           it lies beyond a segment; then 3a
//
// The paper does not tell what becomes of wide angles where the inner borders do not meet, in lines that are wider than their
// segments are long: by method 2 they have gaps. With 3b, both segments end across there, with a corner on the outer side:
//
//          a ------ c          b   the vertex's middle        a-c-d-b   the corner, of two triangles
//                 /   `.
//     ___________b.     d      middle pairs of three or four are there for these, and for triangles without area
//
// Each joint gives one to four pairs of a left and a right corner, as offsets from the vertex in half widths.
#pragma once

#include <vector>

#include "decalgl/core/span.h"
#include "decalgl/technique/clipmap_options.h"
#include "vector/stroke_reach.h"

namespace decalgl::clipmap {

struct CornerPair {
    uint32_t vertex;
    Vector2 left;
    Vector2 right;
};

struct JointRule {
    double bevel_below = 90.0;  // degrees
    JointMethod joints = JointMethod::inner_meets;
};

// Of a line, or of a ring that ends with its first vertex; no vertex equals the one before it.
std::vector<CornerPair> corner_pairs(Span<const Vector2> line, bool closed, double half_width,
                                     JointRule rule);

}  // namespace decalgl::clipmap

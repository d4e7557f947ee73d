// Joints of lines for triangle strips: Taibo et al. 2014, section 4.2 and algorithm 1.
//
//     ends                method 1: across the segment
//     wide angles         method 2: where the borders meet
//     angles below a      method 3a: both segments' own corners     3b: the inner borders' meeting point twice, unless
//     threshold           it lies beyond a segment; then 3a
//
// Each joint gives one or two pairs of a left and a right corner, as offsets from the vertex in half widths.
#pragma once

#include <vector>

#include "decalgl/core/span.h"
#include "vector/stroke_reach.h"

namespace decalgl::clipmap {

struct CornerPair {
    uint32_t vertex;
    Vector2 left;
    Vector2 right;
};

struct JointRule {
    double bevel_below = 90.0;  // degrees
    bool inner_meets = true;    // 3b
};

// Of a line, or of a ring that ends with its first vertex; no vertex equals the one before it.
std::vector<CornerPair> corner_pairs(Span<const Vector2> line, bool closed, double half_width,
                                     JointRule rule);

}  // namespace decalgl::clipmap

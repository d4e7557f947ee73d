// Strokes as convex pieces: a bar along each segment, a wedge at each corner, caps.
//
//     bars that bend little       one edge between them        +-----+-----+
//                                                              +-----+-----+
//     others                      the inner borders meet, the outer ones have a wedge between them
//     where they do not meet      bars lie over each other
//
// Pieces have their common edges at the same points, so that extruding them makes no walls there.
#pragma once

#include <functional>

#include "decalgl/core/span.h"
#include "decalgl/vector/stroke.h"
#include "technique/shadow_volumes/lattice.h"

namespace decalgl::volume {

// Called with the corners of a convex piece, counter-clockwise, and its number: pieces of one number do not
// lie over each other.
using PieceFn = std::function<void(Span<const Vector2> corners, uint32_t number)>;

struct StrokeShape {
    double half_width;  // quanta
    Corner corner;
    Cap cap;
    double miter_limit;  // degrees
    double arc_step;     // radians between the vertices of a round corner or cap
};

// Of one part of a feature, in quanta; `ring`: closed without repeating its first vertex.
void cut_stroke(Span<const Vector2> part, bool ring, const StrokeShape& shape, const PieceFn& add);

}  // namespace decalgl::volume

// Whether strokes cover points: styled_strokes.glsl on the CPU.
#pragma once

#include "technique/static_bvh/looks.h"
#include "vector/slope.h"

namespace decalgl::bvh {

// The place across the stroke, from 0 at its middle to 1 at its border, at which a segment covers a point on a
// slope; above 1 where it does not. The segment goes by its place in the group.
double stroke_share(const DecalGroup& group, uint32_t segment, LatticePoint point, const Slope& slope);

// Whether a stroke shows anything there: bands may be transparent.
bool band_shows(const DecalGroup& group, uint32_t slot, double share);

}  // namespace decalgl::bvh

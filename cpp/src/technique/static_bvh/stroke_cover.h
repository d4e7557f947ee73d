// Whether strokes cover points: styled_strokes.glsl on the CPU.
#pragma once

#include "technique/static_bvh/looks.h"

namespace decalgl::bvh {

// Whether a segment, which goes by its place in the group, covers a point of the map plane.
bool stroke_covers(const DecalGroup& group, uint32_t segment, LatticePoint point);

}  // namespace decalgl::bvh

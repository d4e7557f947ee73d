// Patterns whose lengths are those on the ground, as those of strokes with slope_correction "tangent" are: such features get a
// vertex wherever the ground under them bends, so that between two vertices a length on the ground is one on the map times the
// edge's slant (features.h).
//
//         o--____o----b     a, b   vertices of a line, from the side
//      a_/                  o      where it passes from one triangle of the terrain to the next
#pragma once

#include "decalgl/core/memory.h"
#include "decalgl/terrain/heightfield.h"
#include "decalgl/vector/layer.h"

namespace decalgl {

// Whether a stroke has a pattern that is measured along the ground.
bool follows_ground(const StrokeStyle& style);
bool follows_ground(const Stroke& stroke);

// Features of a layer that is drawn over this terrain: the same ones where no stroke of the layer follows the ground.
// Throws Error(memory).
Features on_ground(const Features& features, const Layer& layer, const Heightfield& terrain,
                   const MemoryAccount& memory);

}  // namespace decalgl

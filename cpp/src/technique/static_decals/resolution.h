// How many buckets a static decal grid gets.
#pragma once

#include "decalgl/technique/technique.h"

namespace decalgl {

// Buckets along the longer side: enough that one holds some hundred edges and the lattice is fine, but no more
// than so many that wide strokes and the insides of large overlapping polygons would repeat in cell after
// cell, were their buckets cut into the fewest cells.
int32_t choose_resolution(const TechniqueInput& input);

}  // namespace decalgl

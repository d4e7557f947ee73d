// How many cells a static decal grid gets.
#pragma once

#include "decalgl/technique/technique.h"

namespace decalgl {

// Cells along the longer side: enough that a cell holds about one segment and the lattice is fine, but no
// more than so many that wide strokes and the insides of large overlapping polygons would repeat in cell
// after cell.
int32_t choose_resolution(const TechniqueInput& input);

}  // namespace decalgl

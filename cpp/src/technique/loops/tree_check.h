// Whether the paper's index, as it lies in a file, leads a shader nowhere else than through itself.
#pragma once

#include "technique/loops/prepared_loops.h"

namespace decalgl::loops {

// All ways down from the root lead on to other nodes, children cover their parent's box, and lists name points and slots
// that there are.
bool fits_together(const Bvh& bvh, size_t points, size_t slots, const LatticeBox& box);

}  // namespace decalgl::loops

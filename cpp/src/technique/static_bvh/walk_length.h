// How many turns the shader's loops take for one point, at the most.
#pragma once

#include "technique/static_bvh/prepared_bvh.h"

namespace decalgl::bvh {

// An upper bound over all points of the group's grid.
uint64_t longest_walk(const DecalGroup& group, unsigned threads);
// Over those of some of its cells.
uint64_t longest_walk(const DecalGroup& group, Span<const uint32_t> cells);

}  // namespace decalgl::bvh

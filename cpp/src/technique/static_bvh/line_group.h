// Lines as segments in cells (Zechmeister 2020, section 4.2.1; Thöny et al. 2018, section 3.1).
#pragma once

#include "technique/static_bvh/cell_objects.h"
#include "technique/static_bvh/lattice_parts.h"

namespace decalgl::bvh {

// Fills a group whose styles are set already.
void build_lines(const TechniqueInput& input, LatticeParts parts, const Lattice& lattice, DecalGroup& group,
                 MemoryCharge& charge, const Stage& stage);

}  // namespace decalgl::bvh

// Lists of objects in cells, made anew for a built group: in another draw order, or with objects added.
#pragma once

#include "technique/static_bvh/prepared_bvh.h"

namespace decalgl::bvh {

// The lists of all cells by their slots' ranks.
void sort_cells(DecalGroup& group, const BvhOptions& options, unsigned threads, const MemoryAccount& memory);

// Adds what another group holds, built for the same grid. `slot_of` names each of its slots in this one, whose styles
// know them already. Objects of slots without a rank leave the cells that anything is added to, which are returned.
std::vector<uint32_t> add_objects(DecalGroup& group, const DecalGroup& local,
                                  const std::vector<uint32_t>& slot_of, const BvhOptions& options,
                                  const MemoryAccount& memory);

}  // namespace decalgl::bvh

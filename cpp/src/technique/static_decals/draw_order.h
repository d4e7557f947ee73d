// The order in which decals are drawn: ranks of slots, and the groups of each list from the topmost down.
#pragma once

#include "technique/static_decals/prepared_decals.h"

namespace decalgl {

// Ranks of all slots after the features of one layer have changed places among themselves.
void reorder(const LayerLook& look, PreparedDecals& decals);

// Sorts the groups of every list by rank, into words of their own.
void sort_lists(PreparedDecals& decals, const MemoryAccount& memory);

}  // namespace decalgl

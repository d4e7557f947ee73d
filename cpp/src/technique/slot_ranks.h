// Draw orders of prepared decals: the rank of each slot, the topmost 0. Slots keep their numbers, as lists, ids and styles
// name them.
#pragma once

#include "decalgl/core/large_array.h"
#include "technique/layer_rules.h"

namespace decalgl {

// Of slots without ranks the first is the topmost. A slot of this rank is not drawn any more.
constexpr uint32_t no_rank = 0xFFFFFFFFU;

// After the features of one layer have changed places among themselves.
LargeArray<uint32_t> reordered_ranks(const LayerLook& look, const LayerRules& rules, Span<const Decal> slots,
                                     Span<const uint32_t> ranks);

// With decals added, topmost first, each right above all others of its class: those of its layer that lie below outlines
// and strokes, or the others. They follow the slots.
LargeArray<uint32_t> ranks_with_added(Span<const Decal> slots, Span<const uint32_t> ranks,
                                      Span<const Decal> added, Span<const LayerRules> rules);

}  // namespace decalgl

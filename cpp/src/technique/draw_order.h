// Draw orders of prepared decals. Slots keep their numbers, as lists, ids and styles name them: what changes is their rank,
// the topmost 0, or a list of them from bottom to top.
#pragma once

#include <vector>

#include "decalgl/core/large_array.h"
#include "technique/layer_rules.h"

namespace decalgl {

// Of slots without ranks the first is the topmost. A slot of this rank is not drawn any more.
constexpr uint32_t no_rank = 0xFFFFFFFFU;

// The slots of a layer bottom to top, with its features in this order; what cuts a decal off comes right above it. Slots of
// no rank stay out.
std::vector<uint32_t> upwards(Span<const Decal> slots, Span<const uint32_t> ranks, uint32_t layer,
                              Span<const int64_t> draw_order, OutlineOrder outlines);

// All slots bottom to top, given how they lay over each other before; those of the layer share the places that they had.
std::vector<uint32_t> reordered(Span<const Decal> slots, Span<const uint32_t> before, uint32_t layer,
                                Span<const int64_t> draw_order, OutlineOrder outlines);

// The same as ranks.
LargeArray<uint32_t> reordered_ranks(const LayerLook& look, const LayerRules& rules, Span<const Decal> slots,
                                     Span<const uint32_t> ranks);

// With decals added, topmost first, each right above all others of its class: those of its layer that lie below outlines
// and strokes, or the others. They follow the slots.
LargeArray<uint32_t> ranks_with_added(Span<const Decal> slots, Span<const uint32_t> ranks,
                                      Span<const Decal> added, Span<const LayerRules> rules);

// Each of the numbers below `count` once.
bool permutes(Span<const uint32_t> numbers, size_t count);

}  // namespace decalgl

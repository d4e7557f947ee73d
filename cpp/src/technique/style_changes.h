// Which other styles a prepared stroke may be given: those of which the index has all places.
//
//     pattern   other marks in the same period, from where the line begins in it
//     corner    round and bevel, where not everything is round; a miter where it was one that reached as far
//     bands     others, where it had some
//     hatch     any, as it is decided by the position alone
#pragma once

#include "technique/layer_rules.h"
#include "technique/layer_sources.h"

namespace decalgl {

bool has_styles(Span<const LayerLook> looks);

// What cells hold of a corner: all that its disc may touch, or what an outline of just this corner does.
enum class CornerRoom { disc, outline };

// `sources` are null for an index that was opened from a file without them. Throws Error(style), which says what the index
// was not made for, Error(unsupported).
void require_styles(const LayerLook& look, const LayerSources* sources, Span<const Decal> slots,
                    CornerRoom room);

// The styles of the looks as layers without features, by their places in the scene.
std::vector<Layer> layers_of_styles(Span<const LayerLook> looks, size_t layer_count);

}  // namespace decalgl

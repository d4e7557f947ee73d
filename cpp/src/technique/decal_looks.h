// Looks of prepared decals: what techniques have in common that draw one decal after the other.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "decalgl/core/span.h"
#include "decalgl/vector/decal.h"
#include "decalgl/vector/layer_look.h"

namespace decalgl {

struct PlainLook {
    std::array<uint8_t, 4> color{};  // straight alpha
    float half_width = 0.0F;         // metres; of fills 0

    bool shows(bool is_stroke) const { return color[3] != 0 && (!is_stroke || half_width > 0.0F); }
};
static_assert(sizeof(PlainLook) == 8, "a texel of RG32UI, and saved as it is");

PlainLook look_of(const DecalView& view);

// How a layer of so many features looks. `color_of(i)` and `width_of(i)` of a decal: four bytes, and metres.
template <typename ColorFn, typename WidthFn>
LayerLook layer_look(Span<const Decal> decals, uint32_t layer, size_t features, ColorFn color_of,
                     WidthFn width_of) {
    LayerLook result;
    result.layer = layer;
    for (size_t i = 0; i < decals.size(); ++i) {
        const Decal& decal = decals[i];
        DecalLook* look = decal.feature.layer == layer ? result.of(decal.role) : nullptr;
        if (look == nullptr || decal.feature.feature >= features)
            continue;
        look->colors.resize(4 * features, 0);
        std::copy_n(color_of(i), 4, &look->colors[size_t{4} * decal.feature.feature]);
        if (!decal.is_stroke())
            continue;
        look->widths.resize(features, 0.0);
        look->widths[decal.feature.feature] = width_of(i);
    }
    return result;
}
LayerLook layer_look(Span<const Decal> decals, Span<const PlainLook> looks, uint32_t layer, size_t features);

// The looks that decals have from now on.
std::vector<PlainLook> changed_looks(Span<const Decal> decals, Span<const PlainLook> before,
                                     Span<const LayerLook> changes);

}  // namespace decalgl

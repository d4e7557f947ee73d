#include "technique/decal_looks.h"

namespace decalgl {

PlainLook look_of(const DecalView& view) {
    PlainLook look;
    std::copy_n(view.color(), 4, look.color.begin());
    look.half_width = static_cast<float>(view.half_width());
    return look;
}

LayerLook layer_look(Span<const Decal> decals, Span<const PlainLook> looks, uint32_t layer, size_t features) {
    return layer_look(
        decals, layer, features, [&](size_t i) { return looks[i].color.data(); },
        [&](size_t i) { return 2.0 * static_cast<double>(looks[i].half_width); });
}

std::vector<PlainLook> changed_looks(Span<const Decal> decals, Span<const PlainLook> before,
                                     Span<const LayerLook> changes) {
    std::vector<PlainLook> looks(before.begin(), before.end());
    for (const LayerLook& change : changes) {
        for (size_t i = 0; i < decals.size(); ++i) {
            const DecalLook* look =
                decals[i].feature.layer == change.layer ? change.of(decals[i].role) : nullptr;
            if (look == nullptr)
                continue;
            const uint32_t feature = decals[i].feature.feature;
            if (!look->colors.empty())
                std::copy_n(look->color(feature), 4, looks[i].color.begin());
            if (!look->widths.empty() && decals[i].is_stroke())
                looks[i].half_width = static_cast<float>(0.5 * look->width(feature));
        }
    }
    return looks;
}

}  // namespace decalgl

#include "decalgl/vector/decal.h"

#include <algorithm>

namespace decalgl {
namespace {

void add_if_seen(const Layer& layer, const Decal& decal, Hidden hidden, std::vector<Decal>& decals) {
    const DecalView view{&layer, decal};
    if (decal.is_stroke() ? view.stroke().empty() || view.widest_half_width() <= 0.0 : layer.fill.empty())
        return;
    if (hidden == Hidden::kept || view.color()[3] != 0)
        decals.push_back(decal);
}

}  // namespace

double DecalView::half_width() const {
    if (!decal.is_stroke())
        return 0.0;
    const double width = stroke().width(feature());
    return cut() == OutlineMode::normal ? 0.5 * width : width;
}

double DecalView::widest_half_width() const {
    if (!decal.is_stroke())
        return 0.0;
    return std::max(half_width(), cut() == OutlineMode::normal ? 0.5 * stroke().widest : stroke().widest);
}

std::vector<Decal> decals_of(Span<const Layer> layers, uint32_t first_layer, Hidden hidden) {
    std::vector<Decal> decals;
    for (size_t l = 0; l < layers.size(); ++l) {
        const Layer& layer = layers[l];
        const bool lines = layer.features.kind == FeatureKind::lines;
        const auto add_all = [&](DecalRole role) {
            for (size_t rank = 0; rank < layer.features.feature_count(); ++rank)
                add_if_seen(
                    layer,
                    {{first_layer + static_cast<uint32_t>(l), static_cast<uint32_t>(layer.feature_at(rank))},
                     role},
                    hidden, decals);
        };
        if (lines || layer.outline_order == OutlineOrder::layer) {
            add_all(lines ? DecalRole::casing : DecalRole::fill);
            add_all(DecalRole::stroke);
            continue;
        }
        for (size_t rank = 0; rank < layer.features.feature_count(); ++rank) {
            const FeatureReference feature{first_layer + static_cast<uint32_t>(l),
                                           static_cast<uint32_t>(layer.feature_at(rank))};
            add_if_seen(layer, {feature, DecalRole::fill}, hidden, decals);
            add_if_seen(layer, {feature, DecalRole::stroke}, hidden, decals);
        }
    }
    return decals;
}

}  // namespace decalgl

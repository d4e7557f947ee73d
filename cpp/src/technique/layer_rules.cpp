#include "technique/layer_rules.h"

#include <algorithm>
#include <string>

#include "decalgl/core/error.h"

namespace decalgl {

std::vector<LayerRules> rules_of(const TechniqueInput& input) {
    std::vector<LayerRules> rules(input.first_layer, LayerRules{0.0, 0.0, 0.5, 0});
    for (const Layer& layer : input.layers)
        rules.push_back({layer.stroke.widest, layer.casing.widest,
                         layer.outline_mode == OutlineMode::normal ? 0.5 : 1.0,
                         layer.outline_order == OutlineOrder::feature ? uint64_t{1} : uint64_t{0}});
    return rules;
}

bool has_widths(const LayerLook& look) {
    return !look.stroke.widths.empty() || !look.casing.widths.empty();
}

void require_widths(const LayerLook& look, const LayerRules& rules) {
    for (const DecalRole role : {DecalRole::stroke, DecalRole::casing}) {
        const std::vector<double>& widths = look.of(role)->widths;
        if (widths.empty())
            continue;
        const double widest = role == DecalRole::casing ? rules.casing_widest : rules.stroke_widest;
        if (widest <= 0.0)
            throw Error(
                ErrorKind::style,
                "its widths are fixed, since it was prepared without widest; say with widest, where the "
                "layer is made, how wide its lines may become");
        const double wanted = *std::max_element(widths.begin(), widths.end());
        if (wanted > widest)
            throw Error(ErrorKind::style,
                        "a width of " + std::to_string(wanted) +
                            " m is more than it was prepared for; make the layer with a widest "
                            "above its " +
                            std::to_string(widest) + " m");
    }
}

}  // namespace decalgl

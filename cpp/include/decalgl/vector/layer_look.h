// How the features of a prepared layer are to look from now on: what changes without preparing anew.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "decalgl/vector/decal.h"

namespace decalgl {

// Of all fills, strokes or casings of a layer; what is empty stays as it is. Styles are of the kinds that the layer was
// prepared for (technique/style_changes.h).
struct DecalLook {
    std::vector<uint8_t>
        colors;  // R, G, B, A, sRGB, straight alpha: one, or one a feature; alpha 0: not there
    std::vector<double> widths;       // metres on the map plane: one, or one a feature; 0: not there
    std::vector<StrokeStyle> styles;  // of strokes
    std::vector<uint32_t> style_of;   // each feature's place in `styles`; empty: the first for all
    std::vector<Hatch> hatches;       // of fills
    std::vector<uint32_t> hatch_of;

    bool has_styles() const { return !styles.empty() || !hatches.empty(); }
    const uint8_t* color(size_t feature) const { return &colors[colors.size() == 4 ? 0 : 4 * feature]; }
    double width(size_t feature) const { return widths[widths.size() == 1 ? 0 : feature]; }
};

struct LayerLook {
    uint32_t layer = 0;  // place in the scene
    DecalLook fill;
    DecalLook stroke;
    DecalLook casing;
    std::vector<int64_t> draw_order;                  // features from bottom to top; empty: as it is
    std::shared_ptr<const TechniqueOptions> options;  // of the layer's technique; null: as they are

    // Null for decals that are not drawn themselves.
    const DecalLook* of(DecalRole role) const {
        switch (role) {
            case DecalRole::fill:
                return &fill;
            case DecalRole::stroke:
                return &stroke;
            case DecalRole::casing:
                return &casing;
            case DecalRole::clip:
                break;
        }
        return nullptr;
    }
    DecalLook* of(DecalRole role) {
        return const_cast<DecalLook*>(static_cast<const LayerLook&>(*this).of(role));
    }
};

// Throws Error(style) or Error(input) that names the layer and the cure.
void validate(const LayerLook& look, size_t features, const std::string& layer_name);

}  // namespace decalgl

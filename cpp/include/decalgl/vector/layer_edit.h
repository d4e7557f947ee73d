// An edit of one prepared layer: features that go, come or get another geometry.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "decalgl/vector/layer_look.h"

namespace decalgl {

struct LayerEdit {
    uint32_t layer = 0;              // place in the scene
    std::vector<uint32_t> removed;   // places of features in the layer
    std::vector<uint32_t> replaced;  // those that get the first geometries; how they look stays
    // Of the replaced features, then of those that are added on top of the layer; with their rows.
    Features geometry;
    // How the added features look: colours and widths, one, or one for each of them. Whatever else their decals share is that
    // of the layer's first feature.
    DecalLook fill;
    DecalLook stroke;
    DecalLook casing;

    size_t added_count() const { return geometry.feature_count() - replaced.size(); }
};

// Throws Error(input) or Error(style) that names the layer, which has `features` of this kind.
void validate(const LayerEdit& edit, FeatureKind kind, size_t features, const std::string& layer_name);

}  // namespace decalgl

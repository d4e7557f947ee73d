#include "decalgl/vector/layer_edit.h"

#include "decalgl/core/error.h"

namespace decalgl {

void validate(const LayerEdit& edit, FeatureKind kind, size_t features, const std::string& layer_name) {
    const auto refuse = [&](const std::string& what) {
        throw Error(ErrorKind::input, "layer '" + layer_name + "': " + what);
    };
    validate(edit.geometry, layer_name);
    if (edit.geometry.kind != kind)
        refuse("lines and polygons do not share a layer");
    if (edit.geometry.feature_count() < edit.replaced.size())
        refuse("each feature that is replaced needs a geometry");
    std::vector<bool> is_changed(features, false);
    for (const std::vector<uint32_t>* places : {&edit.removed, &edit.replaced}) {
        for (const uint32_t feature : *places) {
            if (feature >= features || is_changed[feature])
                refuse("an edit names each of its features once");
            is_changed[feature] = true;
        }
    }
    LayerLook look;
    look.fill = edit.fill;
    look.stroke = edit.stroke;
    look.casing = edit.casing;
    validate(look, edit.added_count(), layer_name);
}

}  // namespace decalgl

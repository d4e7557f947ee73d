#include "decalgl/vector/layer.h"

#include "decalgl/core/error.h"

namespace decalgl {
namespace {

[[noreturn]] void refuse(const std::string& layer_name, const std::string& what) {
    throw Error(ErrorKind::input, "layer '" + layer_name + "': " + what);
}

}  // namespace

void validate_draw_order(const std::vector<int64_t>& draw_order, size_t features,
                         const std::string& layer_name) {
    if (draw_order.empty())
        return;
    std::vector<bool> seen(features, false);
    bool permutes = draw_order.size() == features;
    for (size_t i = 0; permutes && i < features; ++i) {
        const int64_t feature = draw_order[i];
        permutes =
            feature >= 0 && feature < static_cast<int64_t>(features) && !seen[static_cast<size_t>(feature)];
        if (permutes)
            seen[static_cast<size_t>(feature)] = true;
    }
    if (!permutes)
        refuse(layer_name, "the draw order must name each of its features once");
}

void validate(const Layer& layer) {
    validate(layer.features, layer.name);
    const size_t count = layer.features.feature_count();
    const bool lines = layer.features.kind == FeatureKind::lines;
    if (lines ? !layer.fill.empty() : !layer.casing.empty())
        refuse(layer.name,
               lines ? "lines have no fill; leave it out" : "polygons have no casing; leave it out");
    if (count > 0 && layer.stroke.empty() && layer.fill.empty())
        refuse(layer.name, "needs one colour, or one for each of its " + std::to_string(count) + " features");
    validate(layer.fill, count, layer.name);
    validate(layer.stroke, count, layer.name);
    validate(layer.casing, count, layer.name);
    validate_draw_order(layer.draw_order, count, layer.name);
}

}  // namespace decalgl

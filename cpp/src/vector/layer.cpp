#include "decalgl/vector/layer.h"

#include "decalgl/core/error.h"

namespace decalgl {
namespace {

[[noreturn]] void refuse(const Layer& layer, const std::string& what) {
    throw Error(ErrorKind::input, "layer '" + layer.name + "': " + what);
}

void validate_draw_order(const Layer& layer) {
    if (layer.draw_order.empty())
        return;
    const size_t count = layer.features.feature_count();
    std::vector<bool> seen(count, false);
    bool permutes = layer.draw_order.size() == count;
    for (size_t i = 0; permutes && i < count; ++i) {
        const int64_t feature = layer.draw_order[i];
        permutes =
            feature >= 0 && feature < static_cast<int64_t>(count) && !seen[static_cast<size_t>(feature)];
        if (permutes)
            seen[static_cast<size_t>(feature)] = true;
    }
    if (!permutes)
        refuse(layer, "the draw order must name each of its features once");
}

}  // namespace

void validate(const Layer& layer) {
    validate(layer.features, layer.name);
    const size_t count = layer.features.feature_count();
    const bool lines = layer.features.kind == FeatureKind::lines;
    if (lines ? !layer.fill.empty() : !layer.casing.empty())
        refuse(layer, lines ? "lines have no fill; leave it out" : "polygons have no casing; leave it out");
    if (count > 0 && layer.stroke.empty() && layer.fill.empty())
        refuse(layer, "needs one colour, or one for each of its " + std::to_string(count) + " features");
    validate(layer.fill, count, layer.name);
    validate(layer.stroke, count, layer.name);
    validate(layer.casing, count, layer.name);
    validate_draw_order(layer);
}

}  // namespace decalgl

#include "decalgl/vector/layer.h"

#include <cmath>

#include "decalgl/core/error.h"

namespace decalgl {
namespace {

[[noreturn]] void refuse(const Layer& layer, const std::string& what) {
    throw Error(ErrorKind::input, "layer '" + layer.name + "': " + what);
}

void validate_widths(const Layer& layer) {
    const size_t count = layer.features.feature_count();
    if (layer.features.kind == FeatureKind::polygons) {
        if (!layer.widths.empty())
            refuse(layer, "polygons have no width; leave it out");
        return;
    }
    if (layer.widths.size() != 1 && layer.widths.size() != count)
        refuse(layer, "needs one width, or one for each of its " + std::to_string(count) + " features");
    for (size_t i = 0; i < layer.widths.size(); ++i) {
        if (!std::isfinite(layer.widths[i]) || layer.widths[i] <= 0.0)
            refuse(layer, "feature " + std::to_string(i) + " has width " + std::to_string(layer.widths[i]) +
                              "; widths are positive lengths in metres");
    }
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
    if (layer.colors.size() != 4 && layer.colors.size() != 4 * count)
        refuse(layer, "needs one colour, or one for each of its " + std::to_string(count) + " features");
    validate_widths(layer);
    validate_draw_order(layer);
}

}  // namespace decalgl

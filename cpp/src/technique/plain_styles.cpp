#include "technique/plain_styles.h"

#include <algorithm>

#include "decalgl/core/error.h"

namespace decalgl {
namespace {

// The first thing that cannot be drawn; null: all can.
const char* other_than_plain(const Stroke& stroke) {
    if (stroke.empty())
        return nullptr;
    for (const StrokeStyle& style : stroke.styles) {
        if (style.pattern.period > 0.0)
            return "patterns along lines";
        if (!style.bands.empty())
            return "bands of colour across lines";
        if (style.slope_correction != SlopeCorrection::none)
            return "widths that are corrected on slopes";
    }
    return nullptr;
}

const char* other_than_plain(const Layer& layer) {
    for (const Stroke* stroke : {&layer.stroke, &layer.casing})
        if (const char* what = other_than_plain(*stroke))
            return what;
    if (layer.features.kind != FeatureKind::polygons)
        return nullptr;
    if (!layer.stroke.empty() && layer.outline_mode != OutlineMode::normal)
        return "outlines on one side of a border";
    const bool is_hatched =
        !layer.fill.empty() && std::any_of(layer.fill.hatches.begin(), layer.fill.hatches.end(),
                                           [](const Hatch& hatch) { return hatch.spacing > 0.0; });
    return is_hatched ? "hatches" : nullptr;
}

}  // namespace

void require_plain_styles(const Layer& layer, const std::string& technique) {
    const std::string place = "layer '" + layer.name + "': technique '" + technique + "' ";
    if (const char* what = other_than_plain(layer))
        throw Error(
            ErrorKind::unsupported,
            place + "cannot draw " + what + "; leave that out, or draw the layer with technique 'static'");
    const bool has_fills = layer.features.kind == FeatureKind::polygons && !layer.fill.empty();
    if (has_fills && layer.triangles.first_of.size() != layer.features.feature_count() + 1)
        throw Error(ErrorKind::unsupported,
                    place +
                        "needs polygons cut into triangles (Layer::triangles), which the Python package "
                        "does; set them, or draw the layer with technique 'static'");
}

uint64_t segments_of(Span<const Layer> layers) {
    uint64_t segments = 0;
    for (const Layer& layer : layers) {
        const Features& features = layer.features;
        const uint64_t fewer = features.kind == FeatureKind::polygons ? 0 : features.part_count();
        segments += features.vertex_count() - std::min<uint64_t>(fewer, features.vertex_count());
    }
    return segments;
}

}  // namespace decalgl

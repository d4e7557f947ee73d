#include "technique/static_decals/resolution.h"

#include <algorithm>
#include <cmath>

namespace decalgl {
namespace {

constexpr int32_t coarsest = 64;
constexpr int32_t coarsest_wanted = 1024;
constexpr int32_t finest = 4096;
constexpr size_t samples_per_layer = 4096;
constexpr double references_per_segment = 8.0;

// The number of cells of a size that the layer's strokes touch, estimated from evenly spread features.
double estimate_references(const Layer& layer, double cell_size) {
    const Features& features = layer.features;
    const size_t count = features.feature_count();
    const size_t step = std::max<size_t>(1, count / samples_per_layer);
    double references = 0.0;
    for (size_t feature = 0; feature < count; feature += step) {
        const double width = layer.width(feature);
        const auto first = static_cast<size_t>(features.feature_offsets[feature]);
        const auto last = static_cast<size_t>(features.feature_offsets[feature + 1]);
        const auto vertices = static_cast<double>(features.part_offsets[last] - features.part_offsets[first]);
        const double across = 1.0 + width / cell_size;
        references += static_cast<double>(step) * vertices * across * across;
    }
    return references;
}

}  // namespace

int32_t choose_resolution(const TechniqueInput& input) {
    double segments = 0.0;
    for (const Layer& layer : input.layers)
        segments += static_cast<double>(layer.features.vertex_count());
    const double wanted = std::exp2(std::round(std::log2(std::sqrt(std::max(segments, 1.0) / 1.2))));
    auto resolution = std::clamp(static_cast<int32_t>(wanted), coarsest_wanted, finest);

    const double extent =
        std::max(input.bounds.max_x - input.bounds.min_x, input.bounds.max_y - input.bounds.min_y);
    const double allowed = references_per_segment * segments + 65536.0;
    for (; resolution > coarsest; resolution /= 2) {
        double references = 0.0;
        for (const Layer& layer : input.layers)
            if (layer.features.kind == FeatureKind::lines)
                references += estimate_references(layer, extent / resolution);
        if (references <= allowed)
            break;
    }
    return resolution;
}

}  // namespace decalgl

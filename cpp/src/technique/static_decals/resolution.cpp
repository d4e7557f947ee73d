#include "technique/static_decals/resolution.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "technique/static_decals/cell_lists.h"

namespace decalgl {
namespace {

constexpr int32_t coarsest = 8;
constexpr int32_t coarsest_wanted = 64;
constexpr int32_t finest = 256;
constexpr double edges_per_bucket = 100.0;
constexpr size_t samples_per_layer = 4096;

// What an index may hold: some words a segment, and a fixed number for the cells inside large features.
constexpr double words_per_segment = 8.0;
constexpr double words_besides = 1 << 22;

// A feature that stands for `weight` of them.
struct Sample {
    double weight;
    double vertices;
    double width;  // 0 for polygons
    double area;   // of a polygon's bounding box inside the terrain's bounds
};

double area_of(Span<const double> coordinates, const Bounds& bounds) {
    constexpr double far = std::numeric_limits<double>::max();
    Bounds box{far, far, -far, -far};
    for (size_t i = 0; i < coordinates.size(); i += 2) {
        box.min_x = std::min(box.min_x, coordinates[i]);
        box.max_x = std::max(box.max_x, coordinates[i]);
        box.min_y = std::min(box.min_y, coordinates[i + 1]);
        box.max_y = std::max(box.max_y, coordinates[i + 1]);
    }
    const double width = std::min(box.max_x, bounds.max_x) - std::max(box.min_x, bounds.min_x);
    const double height = std::min(box.max_y, bounds.max_y) - std::max(box.min_y, bounds.min_y);
    return std::max(width, 0.0) * std::max(height, 0.0);
}

// Evenly spread features of a layer.
void add_samples(const Layer& layer, const Bounds& bounds, std::vector<Sample>& samples) {
    const Features& features = layer.features;
    const size_t count = features.feature_count();
    const size_t step = std::max<size_t>(1, count / samples_per_layer);
    for (size_t feature = 0; feature < count; feature += step) {
        const Span<const double> coordinates = features.vertices(feature);
        const auto weight = static_cast<double>(std::min(step, count - feature));
        const auto vertices = static_cast<double>(coordinates.size() / 2);
        if (!layer.fill.empty())
            samples.push_back({weight, vertices, 0.0, area_of(coordinates, bounds)});
        for (const Stroke* stroke : {&layer.stroke, &layer.casing}) {
            if (!stroke->empty())
                samples.push_back({weight, vertices, std::max(stroke->width(feature), stroke->widest), 0.0});
        }
    }
}

double estimate_words(const std::vector<Sample>& samples, double cell_size) {
    double words = 0.0;
    for (const Sample& sample : samples) {
        const double across = 1.0 + sample.width / cell_size;
        words += sample.weight * (sample.vertices * across * across + sample.area / (cell_size * cell_size));
    }
    return words;
}

}  // namespace

int32_t choose_resolution(const TechniqueInput& input) {
    double segments = 0.0;
    std::vector<Sample> samples;
    for (const Layer& layer : input.layers) {
        segments += static_cast<double>(layer.features.vertex_count());
        add_samples(layer, input.bounds, samples);
    }
    const double wanted =
        std::exp2(std::round(std::log2(std::sqrt(std::max(segments, 1.0) / edges_per_bucket))));
    auto resolution = std::clamp(static_cast<int32_t>(wanted), coarsest_wanted, finest);

    const double extent =
        std::max(input.bounds.max_x - input.bounds.min_x, input.bounds.max_y - input.bounds.min_y);
    const double allowed = words_per_segment * segments + words_besides;
    const auto coarsest_cell = [&] { return extent / resolution / (1 << COARSEST_LEVEL); };
    while (resolution > coarsest && estimate_words(samples, coarsest_cell()) > allowed)
        resolution /= 2;
    return resolution;
}

}  // namespace decalgl

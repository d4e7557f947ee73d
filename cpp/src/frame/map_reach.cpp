#include "frame/map_reach.h"

#include <algorithm>
#include <cmath>

namespace decalgl {
namespace {

constexpr double radians = 3.14159265358979323846 / 180.0;

void extend(Bounds& bounds, const Features& features) {
    for (size_t i = 0; i + 1 < features.coordinates.size(); i += 2) {
        const double x = features.coordinates[i], y = features.coordinates[i + 1];
        bounds.min_x = std::min(bounds.min_x, x);
        bounds.min_y = std::min(bounds.min_y, y);
        bounds.max_x = std::max(bounds.max_x, x);
        bounds.max_y = std::max(bounds.max_y, y);
    }
}

// A miter's tip is half a width away, divided by the sine of half its angle; outlines on one side are twice as wide.
double sharpest_of(const Stroke& stroke) {
    double sharpest = 1.0;
    for (const StrokeStyle& style : stroke.styles)
        if (style.corner == Corner::miter)
            sharpest = std::max(sharpest, 1.0 / std::sin(0.5 * radians * std::max(style.miter_limit, 1e-6)));
    return sharpest;
}

double widest_of(const std::vector<double>& widths) {
    return widths.empty() ? 0.0 : *std::max_element(widths.begin(), widths.end());
}

bool leaves_widths_to_view(const Layer& layer) {
    return layer.stroke.follows_view() || layer.casing.follows_view() ||
           (layer.technique.options && layer.technique.options->names_widths());
}

}  // namespace

bool MapReach::meets(const Bounds& bounds) const {
    return bounds.min_x <= vertices.max_x + margin && bounds.max_x >= vertices.min_x - margin &&
           bounds.min_y <= vertices.max_y + margin && bounds.max_y >= vertices.min_y - margin;
}

MapReach reach_of(Span<const Layer> layers) {
    MapReach reach;
    for (const Layer& layer : layers) {
        extend(reach.vertices, layer.features);
        if (leaves_widths_to_view(layer))
            reach.margin = std::numeric_limits<double>::infinity();
        for (const Stroke* stroke : {&layer.stroke, &layer.casing})
            reach.sharpest = std::max(reach.sharpest, sharpest_of(*stroke));
    }
    for (const Layer& layer : layers)
        for (const Stroke* stroke : {&layer.stroke, &layer.casing})
            reach.margin =
                std::max(reach.margin, reach.sharpest * std::max(widest_of(stroke->widths), stroke->widest));
    return reach;
}

void extend(MapReach& reach, const LayerEdit& edit) {
    extend(reach.vertices, edit.geometry);
    for (const DecalLook* look : {&edit.stroke, &edit.casing})
        reach.margin = std::max(reach.margin, reach.sharpest * widest_of(look->widths));
}

}  // namespace decalgl

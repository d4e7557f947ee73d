// A layer: features of one kind with their resolved styles and draw order.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "decalgl/vector/features.h"
#include "decalgl/vector/stroke.h"

namespace decalgl {

// Which side of a polygon's border its outline lies on: both, or the whole width on one.
enum class OutlineMode : uint8_t { normal, inset, offset };
// Over all fills of the layer, or each over its own feature's fill.
enum class OutlineOrder : uint8_t { layer, feature };

struct Layer {
    std::string name;
    Features features;
    Fill fill;      // of polygons
    Stroke stroke;  // of lines; of polygons: their outlines
    Stroke casing;  // of lines: under the strokes of all features
    OutlineMode outline_mode = OutlineMode::normal;
    OutlineOrder outline_order = OutlineOrder::layer;
    // Features from bottom to top; empty: as they stand.
    std::vector<int64_t> draw_order;

    size_t feature_at(size_t rank) const {
        return draw_order.empty() ? rank : static_cast<size_t>(draw_order[rank]);
    }
};

// Throws Error(input) that names the layer, the feature and the cure.
void validate(const Layer& layer);
// Empty, or each of the features once. Throws Error(input).
void validate_draw_order(const std::vector<int64_t>& draw_order, size_t features,
                         const std::string& layer_name);

}  // namespace decalgl

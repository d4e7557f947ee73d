// A layer: features of one kind with their resolved styles and draw order.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "decalgl/vector/features.h"

namespace decalgl {

struct Layer {
    std::string name;
    Features features;
    // One colour for all or one for each feature: R, G, B, A bytes, sRGB, straight alpha. A feature with
    // alpha 0 is not drawn, has no id and is not picked.
    std::vector<uint8_t> colors;
    // Lines: width in metres on the map plane, one for all or one for each feature. Polygons: empty.
    std::vector<double> widths;
    // Features from bottom to top; empty: as they stand.
    std::vector<int64_t> draw_order;

    const uint8_t* color(size_t feature) const { return &colors[colors.size() == 4 ? 0 : 4 * feature]; }
    double width(size_t feature) const { return widths[widths.size() == 1 ? 0 : feature]; }
    size_t feature_at(size_t rank) const {
        return draw_order.empty() ? rank : static_cast<size_t>(draw_order[rank]);
    }
};

// Throws Error(input) that names the layer, the feature and the cure.
void validate(const Layer& layer);

}  // namespace decalgl

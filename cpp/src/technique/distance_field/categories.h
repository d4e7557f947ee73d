// Categories: what shares a distance field and a style, and what the shaders read of them (network_layout.h).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "decalgl/core/span.h"
#include "decalgl/technique/distance_field_options.h"

namespace decalgl::network {

struct Slot {
    uint32_t category = no_network_category;
    uint32_t order = 0;  // in which ids lie over each other, from 1

    bool shows() const { return category != no_network_category; }
};

using StyleTexel = std::array<float, 4>;

struct CategoryTable {
    std::vector<NetworkCategory> categories;  // bottom to top
    std::vector<NetworkRaster> rasters;
    std::vector<uint32_t> ordered;  // slots, from the bottom to the top
    std::vector<Slot> slots;        // of the features of all layers
    std::vector<StyleTexel> texels;
    std::vector<StyleTexel> shapes;  // the same without colours: all that fields depend on
    double reach = 0.0;              // metres: the widest half width
    bool lengths = false;            // whether any style runs along the line
    bool slopes = false;             // whether any width follows the slope

    const NetworkCategory& of(Slot slot) const { return categories[slot.category]; }
};

// Throws Error(style) or Error(unsupported) for what cannot be drawn.
CategoryTable make_categories(Span<const Layer> layers, const DistanceFieldOptions& options);

// Whether the fields of a picture hold the same by both tables.
bool same_fields(const CategoryTable& a, const CategoryTable& b);

// The widest half width of a category, and that at a level of detail.
double widest_half_width(const NetworkCategory& category);
NetworkStyle style_at(const NetworkCategory& category, double lod);

}  // namespace decalgl::network

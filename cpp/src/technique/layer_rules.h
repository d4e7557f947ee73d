// What restyling and editing a prepared layer has to know of how it was made.
#pragma once

#include <cstdint>
#include <vector>

#include "decalgl/technique/technique.h"

namespace decalgl {

// Without padding, since it goes into files.
struct LayerRules {
    double stroke_widest;  // metres; 0: widths are fixed
    double casing_widest;
    double half_width_per_width;   // 1 where an outline lies on one side of its border alone, else 0.5
    uint64_t outlines_by_feature;  // whether each outline lies over its own fill, else over all
};
static_assert(sizeof(LayerRules) == 32, "saved as it is");

// By the layers' places in the scene.
std::vector<LayerRules> rules_of(const TechniqueInput& input);

bool has_widths(const LayerLook& look);

// Throws Error(style) for widths that the index was not made for.
void require_widths(const LayerLook& look, const LayerRules& rules);

}  // namespace decalgl

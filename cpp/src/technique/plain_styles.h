// What techniques that draw meshes in plain colours ask of a layer's styles.
#pragma once

#include <cstdint>
#include <string>

#include "decalgl/core/span.h"
#include "decalgl/vector/layer.h"

namespace decalgl {

// Throws Error(unsupported) that names the layer, the technique and what it cannot draw: patterns, bands, hatches, widths
// corrected on slopes, outlines on one side, and polygons that were not cut into triangles.
void require_plain_styles(const Layer& layer, const std::string& technique);

// A ring of n vertices has n edges, a line of n vertices n - 1 segments.
uint64_t segments_of(Span<const Layer> layers);

}  // namespace decalgl

#pragma once

// Lines of equal height, by marching squares over the samples.

#include <cstdint>
#include <vector>

#include "decalgl/terrain/heightfield.h"

namespace decalgl {

/// Polylines as flat arrays: line i has vertices offsets[i] .. offsets[i + 1].
struct Polylines {
    std::vector<double> coordinates;  ///< x, y
    std::vector<std::int64_t> offsets{0};
};

/// Appends the lines at a height in metres, each as one polyline with the higher ground on its left; a closed
/// one repeats its first vertex. Quads with a missing sample have none.
void append_isolines(const Heightfield& heightfield, double level, Polylines& lines);

}  // namespace decalgl

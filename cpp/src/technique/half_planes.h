// The table of half planes, for every technique that filters over a pixel's area.
#pragma once

#include <cstdint>
#include <vector>

namespace decalgl {

// The table of shaders/shared/half_planes.glsl: row by row, a bit a sample. A row more than there
// are turns, for the direction that is the opposite of the first.
std::vector<uint64_t> make_half_planes();

}  // namespace decalgl

// From the G-buffer's packed texels to scene coordinates.
#pragma once

#include <cstdint>
#include <vector>

#include "decalgl/frame/picture_request.h"

namespace decalgl {

// `positions` and `surfaces`: four values a pixel as the G-buffer holds them, row 0 at the top; distances
// count from `base_depth` (view_block.h). Fills `world` with x, y, z a pixel (NaN for sky), `depth` with
// planar eye depth (infinite for sky) and `gradients` with the terrain's x, y a pixel.
void unpack_surface(const std::vector<uint32_t>& positions, const std::vector<float>& surfaces,
                    const PictureRequest& request, const PositionGrid& grid, double base_depth,
                    std::vector<double>& world, std::vector<float>& depth, std::vector<float>& gradients);

}  // namespace decalgl

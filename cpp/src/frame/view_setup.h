// From a camera to the numbers that passes need: the uniform block and the tiles to draw.
#pragma once

#include <vector>

#include "decalgl/frame/camera.h"
#include "decalgl/technique/technique.h"
#include "decalgl/terrain/tiles.h"
#include "shared/view_block.h"

namespace decalgl {

struct VisibleTile {
    const TerrainTile* tile;
    int level;
    glm::ivec4 neighbour_levels;  // west, east, north, south
};

// The tiles in the view, each at the coarsest level that is off by no more than `terrain_error` pixels on the
// screen, whatever was drawn before. `terrain_error` 0: every sample.
std::vector<VisibleTile> select_tiles(const TerrainTiles& tiles, const Heightfield& terrain,
                                      const Camera& camera, int width, int height, double terrain_error);

// The part of the map that a tile covers.
Bounds bounds_of(const TerrainTile& tile, const Heightfield& terrain);

// A depth, exact in float32, that nothing visible lies before; 0 where the eye is among the tiles.
double nearest_depth(const std::vector<VisibleTile>& tiles, const Heightfield& terrain, const Camera& camera);

// Metres across the view that a pixel shows at a depth.
double pixel_at(const Camera& camera, int height, double depth);

// Metres across the view that a pixel of the farthest visible terrain shows.
double widest_pixel(const std::vector<VisibleTile>& tiles, const Heightfield& terrain, const Camera& camera,
                    int height);

// base_depth: of the point that positions are relative to, see view_block.h. Throws Error(input) where that
// point is too far away to be held in block and sample numbers.
ViewBlock make_view_block(const Camera& camera, int width, int height, const Heightfield& terrain,
                          const PositionGrid& positions, double base_depth);

// A place on the map with the ground's gradient there, as a camera sees it in a picture of this height.
SeenPoint seen_point(const Camera& camera, int height, glm::dvec3 place, glm::dvec2 gradient);

}  // namespace decalgl

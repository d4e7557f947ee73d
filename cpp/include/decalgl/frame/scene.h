// A scene: a terrain, how it looks, and the layers drawn over it from bottom to top.
#pragma once

#include <vector>

#include "decalgl/terrain/heightfield.h"
#include "decalgl/terrain/relief.h"
#include "decalgl/vector/layer.h"

namespace decalgl {

struct Scene {
    Heightfield terrain;
    double exaggeration = 1.0;
    Relief relief;
    std::vector<Layer> layers;
};

}  // namespace decalgl

// What remains of a layer once its scene is prepared: its features' geometry has gone into the index.
#pragma once

#include <string>

#include "decalgl/core/shared_array.h"
#include "decalgl/vector/features.h"

namespace decalgl {

struct PreparedLayer {
    std::string name;
    FeatureKind kind = FeatureKind::polygons;
    SharedArray<int64_t> rows;  // of each feature in the user's data
};

}  // namespace decalgl

// How far what a pass draws is seen on the map, so that views of other places leave the pass out.
#pragma once

#include <limits>

#include "decalgl/core/position_grid.h"
#include "decalgl/core/span.h"
#include "decalgl/vector/layer.h"
#include "decalgl/vector/layer_edit.h"

namespace decalgl {

struct MapReach {
    Bounds vertices{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                    -std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    double sharpest = 1.0;  // how many widths a corner may reach beyond its vertex
    double margin =
        0.0;  // metres that strokes reach beyond vertices; infinite where the view decides on widths

    bool meets(const Bounds& bounds) const;
};

MapReach reach_of(Span<const Layer> layers);
// With an edit's features as well.
void extend(MapReach& reach, const LayerEdit& edit);

}  // namespace decalgl

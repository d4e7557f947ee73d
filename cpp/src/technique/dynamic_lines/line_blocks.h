// Boxes around runs of vertices: what a view shows nothing of is told before any of it is matched with the view.
#pragma once

#include <vector>

#include "technique/dynamic_lines/line_looks.h"
#include "technique/dynamic_lines/prepared_lines.h"

namespace decalgl {

class LineBlocks {
public:
    LineBlocks() = default;
    explicit LineBlocks(const PreparedLines& prepared);

    // Whether any box may show: as update_view.glsl asks it of segments, over all heights of the terrain.
    bool may_show(const View& view, glm::vec2 ground_heights, LineReach reach) const;

private:
    std::vector<Bounds> boxes_;  // metres
};

}  // namespace decalgl

// What lies at a place: the meaning of widths in pixels (screen_plane.glsl) in double precision.
#include <algorithm>
#include <cmath>

#include "technique/dynamic_lines/prepared_lines.h"

namespace decalgl {

std::vector<FeatureReference> PreparedLines::query(const SeenPoint&) const {
    return {};
}

}  // namespace decalgl

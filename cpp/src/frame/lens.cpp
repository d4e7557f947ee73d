#include "decalgl/frame/lens.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "decalgl/core/error.h"
#include "frame/lens_mask.h"

namespace decalgl {

bool Lens::contains(double pixel_x, double pixel_y, double map_x, double map_y) const {
    if (!is_on_map())
        return std::hypot(pixel_x - x, pixel_y - y) <= radius;
    bool inside = false;
    for (const LensEdge& edge : edges_of(*this)) {
        if ((edge.y0 > map_y) != (edge.y1 > map_y))
            inside ^= map_x < edge.x0 + (edge.x1 - edge.x0) * (map_y - edge.y0) / (edge.y1 - edge.y0);
    }
    return inside;
}

void validate(const Lens& lens) {
    const auto finite = [](double value) { return std::isfinite(value); };
    if (!finite(lens.x) || !finite(lens.y) || !finite(lens.radius) || lens.radius < 0.0)
        throw Error(ErrorKind::input, "a lens's centre and radius must be finite, in pixels");
    if (!std::all_of(lens.coordinates.begin(), lens.coordinates.end(), finite))
        throw Error(ErrorKind::input, "a lens's vertices must be finite");
    const auto vertices = static_cast<int64_t>(lens.coordinates.size() / 2);
    const bool fits =
        !lens.is_on_map() || (!lens.ring_offsets.empty() && lens.ring_offsets.front() == 0 &&
                              lens.ring_offsets.back() == vertices &&
                              std::is_sorted(lens.ring_offsets.begin(), lens.ring_offsets.end()));
    if (!fits)
        throw Error(ErrorKind::input, "a lens's ring offsets must rise from 0 to its " +
                                          std::to_string(vertices) + " vertices");
}

std::vector<LensEdge> edges_of(const Lens& lens) {
    std::vector<LensEdge> edges;
    for (size_t ring = 0; ring + 1 < lens.ring_offsets.size(); ++ring) {
        const auto begin = static_cast<size_t>(lens.ring_offsets[ring]);
        const auto end = static_cast<size_t>(lens.ring_offsets[ring + 1]);
        for (size_t i = begin; i < end; ++i) {
            const double* from = &lens.coordinates[2 * (i == begin ? end - 1 : i - 1)];
            const double* to = &lens.coordinates[2 * i];
            edges.push_back({from[0], from[1], to[0], to[1]});
        }
    }
    return edges;
}

}  // namespace decalgl

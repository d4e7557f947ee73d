// The part of a convex polygon inside a square: for what reaches beyond a technique's lattice.
#pragma once

#include <vector>

#include "decalgl/core/span.h"
#include "vector/stroke_reach.h"

namespace decalgl {

// On one side of a line along an axis. Cuts are worked out in one direction, so that neighbours are cut at the same point.
inline std::vector<Vector2> cut_at(const std::vector<Vector2>& polygon, double Vector2::*axis, double line,
                                   bool below) {
    const auto keeps = [&](Vector2 p) { return below ? p.*axis <= line : p.*axis >= line; };
    std::vector<Vector2> kept;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const Vector2 here = polygon[i], next = polygon[i + 1 == polygon.size() ? 0 : i + 1];
        if (keeps(here))
            kept.push_back(here);
        if (keeps(here) == keeps(next))
            continue;
        const bool upwards = here.*axis < next.*axis;
        const Vector2 low = upwards ? here : next, high = upwards ? next : here;
        const double share = (line - low.*axis) / (high.*axis - low.*axis);
        Vector2 crossing{low.x + share * (high.x - low.x), low.y + share * (high.y - low.y)};
        crossing.*axis = line;
        kept.push_back(crossing);
    }
    return kept;
}

// Within [low, high] along both axes.
inline std::vector<Vector2> clip_to_square(Span<const Vector2> corners, double low, double high) {
    std::vector<Vector2> polygon(corners.begin(), corners.end());
    for (double Vector2::*axis : {&Vector2::x, &Vector2::y}) {
        polygon = cut_at(polygon, axis, low, false);
        polygon = cut_at(polygon, axis, high, true);
    }
    return polygon;
}

}  // namespace decalgl

#include "technique/dynamic_lines/ring_sides.h"

#include <algorithm>
#include <numeric>

namespace decalgl {
namespace {

struct Edge {
    double x0, y0, x1, y1;  // y0 <= y1
    size_t ring;

    // Where it passes a height between its ends.
    double x_at(double y) const { return x0 + (y - y0) / (y1 - y0) * (x1 - x0); }
};

// The vertex that a ring turns at for certain: of the lowest ones the leftmost. Its turn says which way round the ring goes.
struct Lowest {
    double x, y;
    bool is_left;  // the ring's own inside lies to the left
};

Lowest lowest_of(Span<const double> xy) {
    double area = 0.0;
    size_t at = 0;
    const size_t count = xy.size() / 2;
    for (size_t i = 0; i < count; ++i) {
        const size_t next = (i + 1) % count;
        const double x0 = xy[2 * i] - xy[0], y0 = xy[2 * i + 1] - xy[1];
        const double x1 = xy[2 * next] - xy[0], y1 = xy[2 * next + 1] - xy[1];
        area += x0 * y1 - x1 * y0;
        const bool is_lower =
            xy[2 * i + 1] < xy[2 * at + 1] || (xy[2 * i + 1] == xy[2 * at + 1] && xy[2 * i] < xy[2 * at]);
        if (is_lower)
            at = i;
    }
    return {xy[2 * at], xy[2 * at + 1], area > 0.0};
}

}  // namespace

std::vector<bool> insides_to_the_left(const Features& features, size_t feature) {
    const auto first = static_cast<size_t>(features.feature_offsets[feature]);
    const size_t count = static_cast<size_t>(features.feature_offsets[feature + 1]) - first;
    std::vector<Edge> edges;
    std::vector<Lowest> lowest;
    std::vector<bool> is_left(count, true);
    for (size_t ring = 0; ring < count; ++ring) {
        const Span<const double> xy = features.part(first + ring);
        const size_t vertices = xy.size() / 2;
        lowest.push_back(vertices == 0 ? Lowest{0.0, 0.0, true} : lowest_of(xy));
        is_left[ring] = lowest.back().is_left;
        if (count == 1)
            return is_left;
        for (size_t i = 0; i < vertices; ++i) {
            const size_t next = (i + 1) % vertices;
            Edge edge{xy[2 * i], xy[2 * i + 1], xy[2 * next], xy[2 * next + 1], ring};
            if (edge.y0 > edge.y1)
                edge = {edge.x1, edge.y1, edge.x0, edge.y0, ring};
            if (edge.y0 < edge.y1)
                edges.push_back(edge);
        }
    }
    // Upwards through all edges; how many of other rings a ray from the lowest vertex to the left crosses says whether the
    // ring lies in a hole.
    std::vector<size_t> rings(count);
    std::iota(rings.begin(), rings.end(), 0);
    std::sort(rings.begin(), rings.end(), [&](size_t a, size_t b) { return lowest[a].y < lowest[b].y; });
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.y0 < b.y0; });
    std::vector<const Edge*> passing;
    auto next = edges.begin();
    for (const size_t ring : rings) {
        const Lowest& at = lowest[ring];
        for (; next != edges.end() && next->y0 <= at.y; ++next)
            passing.push_back(&*next);
        passing.erase(std::remove_if(passing.begin(), passing.end(),
                                     [&](const Edge* edge) { return edge->y1 <= at.y; }),
                      passing.end());
        const auto crossed = std::count_if(passing.begin(), passing.end(), [&](const Edge* edge) {
            return edge->ring != ring && edge->x_at(at.y) < at.x;
        });
        if (crossed % 2 == 1)
            is_left[ring] = !is_left[ring];
    }
    return is_left;
}

}  // namespace decalgl

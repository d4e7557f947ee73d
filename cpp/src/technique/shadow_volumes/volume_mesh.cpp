#include "technique/shadow_volumes/volume_mesh.h"

#include <array>

namespace decalgl::volume {
namespace {

// The part of a convex polygon on one side of a line of the lattice. Cuts are worked out in one direction, so that
// neighbours are cut at the same point.
std::vector<Vector2> cut(const std::vector<Vector2>& polygon, double Vector2::*axis, double line, bool below) {
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

std::vector<Vector2> cut_to_lattice(Span<const Vector2> corners) {
    std::vector<Vector2> polygon(corners.begin(), corners.end());
    for (double Vector2::*axis : {&Vector2::x, &Vector2::y}) {
        polygon = cut(polygon, axis, 0.0, false);
        polygon = cut(polygon, axis, lattice_extent, true);
    }
    return polygon;
}

struct Edge {
    uint32_t low;
    uint32_t high;
    int32_t direction;  // 1 from low to high, -1 back
};

}  // namespace

void VolumeMesher::add(Span<const Vector2> corners) {
    const bool inside = std::all_of(corners.begin(), corners.end(), on_lattice);
    const std::vector<Vector2> cut = inside ? std::vector<Vector2>() : cut_to_lattice(corners);
    const Span<const Vector2> polygon = inside ? corners : Span<const Vector2>(cut);
    for (size_t i = 2; i < polygon.size(); ++i)
        add({rounded(polygon[0]), rounded(polygon[i - 1]), rounded(polygon[i])});
}

void VolumeMesher::add(const Triangle& triangle) {
    const int64_t area = doubled_area(triangle.a, triangle.b, triangle.c);
    const HeightRange heights = area == 0 ? HeightRange{} : heights_.under(triangle.box());
    if (heights.empty())
        return;
    triangles_.push_back(vertex(triangle.a, heights));
    triangles_.push_back(vertex(area > 0 ? triangle.b : triangle.c, heights));
    triangles_.push_back(vertex(area > 0 ? triangle.c : triangle.b, heights));
}

uint32_t VolumeMesher::vertex(LatticePoint at, HeightRange heights) {
    const uint64_t key = uint64_t{static_cast<uint32_t>(at.x)} << 32 | static_cast<uint32_t>(at.y);
    const auto [place, is_new] = places_.try_emplace(key, static_cast<uint32_t>(result_.vertices.size()));
    if (is_new)
        result_.vertices.push_back({at.x, at.y, heights.low, heights.high});
    VolumeVertex& found = result_.vertices[place->second];
    found.low = std::min(found.low, heights.low);
    found.high = std::max(found.high, heights.high);
    return place->second;
}

void VolumeMesher::finish(uint32_t decal) {
    if (triangles_.empty())
        return;
    Volume volume{decal, static_cast<uint32_t>(result_.corners.size()), 0,
                  static_cast<uint32_t>(triangles_.size()), {}, {}};
    for (const uint32_t vertex : triangles_) {
        const VolumeVertex& at = result_.vertices[vertex];
        volume.box.add(LatticePoint{at.x, at.y});
        volume.heights.add({at.low, at.high});
        result_.corners.push_back(2 * vertex + 1);
    }
    for (size_t i = 0; i < triangles_.size(); i += 3)
        for (const size_t corner : {i, i + 2, i + 1})
            result_.corners.push_back(2 * triangles_[corner]);
    add_walls();
    volume.corner_count = static_cast<uint32_t>(result_.corners.size()) - volume.first_corner;
    result_.volumes.push_back(volume);
    triangles_.clear();
    places_.clear();
}

// Edges of the same two vertices stand beside each other when sorted; those that run against each other cancel out.
void VolumeMesher::add_walls() {
    std::vector<Edge> edges;
    edges.reserve(triangles_.size());
    for (size_t i = 0; i < triangles_.size(); ++i) {
        const uint32_t from = triangles_[i], to = triangles_[i % 3 == 2 ? i - 2 : i + 1];
        edges.push_back({std::min(from, to), std::max(from, to), from < to ? 1 : -1});
    }
    std::sort(edges.begin(), edges.end(),
              [](const Edge& a, const Edge& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
    for (size_t i = 0; i < edges.size();) {
        int32_t sum = 0;
        const Edge edge = edges[i];
        for (; i < edges.size() && edges[i].low == edge.low && edges[i].high == edge.high; ++i)
            sum += edges[i].direction;
        const uint32_t a = 2 * (sum > 0 ? edge.low : edge.high), b = 2 * (sum > 0 ? edge.high : edge.low);
        for (int32_t copy = 0; copy < std::abs(sum); ++copy)
            for (const uint32_t corner : {a, b, b + 1, a, b + 1, a + 1})
                result_.corners.push_back(corner);
    }
}

}  // namespace decalgl::volume

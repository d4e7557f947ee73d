#include "technique/shadow_volumes/volume_mesh.h"

#include <algorithm>

#include "vector/clip_polygon.h"

namespace decalgl::volume {
namespace {

struct Edge {
    uint32_t low;
    uint32_t high;
    int32_t direction;  // 1 from low to high, -1 back
};

}  // namespace

void VolumeMesher::add(Span<const Vector2> corners) {
    const bool inside = std::all_of(corners.begin(), corners.end(), on_lattice);
    const std::vector<Vector2> cut =
        inside ? std::vector<Vector2>() : clip_to_square(corners, 0.0, lattice_extent);
    const Span<const Vector2> polygon = inside ? corners : Span<const Vector2>(cut);
    for (size_t i = 2; i < polygon.size(); ++i)
        add({rounded(polygon[0]), rounded(polygon[i - 1]), rounded(polygon[i])});
}

void VolumeMesher::add(const Triangle& triangle) {
    const int64_t area = doubled_area(triangle.a, triangle.b, triangle.c);
    const HeightRange heights = area == 0 ? HeightRange{} : heights_.over(lattice_.bounds(triangle.box()));
    if (heights.empty())
        return;
    const auto add = [&](LatticePoint at) {
        points_.push_back(uint64_t{static_cast<uint32_t>(at.x)} << 32 | static_cast<uint32_t>(at.y));
    };
    add(triangle.a);
    add(area > 0 ? triangle.b : triangle.c);
    add(area > 0 ? triangle.c : triangle.b);
    ranges_.push_back(heights);
}

void VolumeMesher::finish(uint32_t decal) {
    mesh(decal, 0, ranges_.size());
    points_.clear();
    ranges_.clear();
}

// Of triangles [begin, end).
void VolumeMesher::mesh(uint32_t decal, size_t begin, size_t end) {
    if (begin == end)
        return;
    if (know_points(begin, end) > most_vertices) {
        const size_t middle = begin + (end - begin) / 2;
        mesh(decal, begin, middle);
        mesh(decal, middle, end);
        return;
    }
    Volume volume{
        decal, static_cast<uint32_t>(result_.vertices.size()), static_cast<uint32_t>(result_.corners.size()),
        0,     static_cast<uint32_t>(3 * (end - begin)),       {},
        {}};
    add_vertices(begin, end);
    for (const uint32_t vertex : triangles_) {
        const VolumeVertex& at = result_.vertices[volume.first_vertex + vertex];
        volume.box.add(LatticePoint{at.x, at.y});
        volume.heights.add(known_ranges_[vertex]);
        add_corner(2 * vertex + 1);
    }
    for (size_t i = 0; i < triangles_.size(); i += 3)
        for (const size_t corner : {i, i + 2, i + 1})
            add_corner(2 * triangles_[corner]);
    add_walls();
    volume.corner_count = static_cast<uint32_t>(result_.corners.size()) - volume.first_corner;
    result_.volumes.push_back(volume);
}

size_t VolumeMesher::know_points(size_t begin, size_t end) {
    known_.assign(points_.begin() + static_cast<std::ptrdiff_t>(3 * begin),
                  points_.begin() + static_cast<std::ptrdiff_t>(3 * end));
    std::sort(known_.begin(), known_.end());
    known_.erase(std::unique(known_.begin(), known_.end()), known_.end());
    return known_.size();
}

// Each known point, with the heights of all triangles that it belongs to.
void VolumeMesher::add_vertices(size_t begin, size_t end) {
    known_ranges_.assign(known_.size(), HeightRange{});
    triangles_.clear();
    for (size_t i = 3 * begin; i < 3 * end; ++i) {
        const auto place = std::lower_bound(known_.begin(), known_.end(), points_[i]) - known_.begin();
        triangles_.push_back(static_cast<uint32_t>(place));
        known_ranges_[static_cast<size_t>(place)].add(ranges_[i / 3]);
    }
    for (size_t i = 0; i < known_.size(); ++i)
        result_.vertices.push_back({static_cast<int32_t>(known_[i] >> 32),
                                    static_cast<int32_t>(known_[i] & 0xFFFFFFFF),
                                    heights_.packed(known_ranges_[i])});
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
                add_corner(corner);
    }
}

}  // namespace decalgl::volume

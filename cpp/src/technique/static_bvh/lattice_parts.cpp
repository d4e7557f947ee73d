#include "technique/static_bvh/lattice_parts.h"

#include <algorithm>
#include <utility>

#include "decalgl/core/parallel.h"
#include "technique/static_bvh/lattice_cut.h"
#include "technique/static_bvh/storage.h"

namespace decalgl::bvh {
namespace {

constexpr size_t parts_at_once = 256;
constexpr size_t vertices_at_once = 1 << 15;

// What is left of an edge that leaves the lattice; what lies beside the lattice moves onto its border.
template <typename OnEdge>
void cut(Place a, Place b, OnEdge on_edge) {
    if (begins_at_b(a, b))
        std::swap(a, b);
    const Share level = narrowed({}, a.y, b.y - a.y);
    const Share inner = narrowed(level, a.x, b.x - a.x);
    const auto keep = [&](double from, double to) {
        on_edge(rounded(between(a, b, from)), rounded(between(a, b, to)));
    };
    if (!inner.empty())
        keep(inner.first, inner.last);
    if (level.empty())
        return;
    const double beside = inner.empty() ? level.last : inner.first;
    if (level.first < beside)
        keep(level.first, beside);
    if (!inner.empty() && inner.last < level.last)
        keep(inner.last, level.last);
}

// One ring as it comes, and what it becomes.
class Source {
public:
    Source(Span<const double> coordinates, const Lattice& lattice)
        : coordinates_(coordinates), lattice_(&lattice) {}

    size_t size() const { return coordinates_.size() / 2; }
    Place place(size_t i) const {
        return {lattice_->x_of(coordinates_[2 * i]), lattice_->y_of(coordinates_[2 * i + 1])};
    }

    bool leaves_lattice() const {
        for (size_t i = 0; i < size(); ++i)
            if (!on_lattice(place(i)))
                return true;
        return false;
    }

    template <typename OnEdge>
    void cut_all(OnEdge on_edge) const {
        for (size_t i = 0; i < size(); ++i)
            cut(place(i), place((i + 1) % size()), on_edge);
    }

private:
    Span<const double> coordinates_;
    const Lattice* lattice_;
};

size_t part_count(const TechniqueInput& input, Span<const FeatureReference> polygons) {
    size_t count = 0;
    for (const FeatureReference& polygon : polygons) {
        const Features& features = input.layers[polygon.layer].features;
        count += static_cast<size_t>(features.feature_offsets[polygon.feature + 1] -
                                     features.feature_offsets[polygon.feature]);
    }
    return count;
}

void list_parts(const TechniqueInput& input, Span<const FeatureReference> polygons, const Lattice& lattice,
                std::vector<LatticePart>& parts, std::vector<Source>& sources) {
    for (size_t polygon = 0; polygon < polygons.size(); ++polygon) {
        const Features& features = input.layers[polygons[polygon].layer].features;
        const auto first = static_cast<size_t>(features.feature_offsets[polygons[polygon].feature]);
        const auto last = static_cast<size_t>(features.feature_offsets[polygons[polygon].feature + 1]);
        for (size_t part = first; part < last; ++part) {
            parts.push_back({static_cast<uint32_t>(polygon), part == first, false, 0, 0});
            sources.emplace_back(features.part(part), lattice);
        }
    }
}

void count_vertices(const Source& source, LatticePart& part) {
    const size_t size = source.size();
    if (size < 3)
        return;
    part.is_pairs = source.leaves_lattice();
    size_t count = size;
    if (part.is_pairs) {
        count = 0;
        source.cut_all([&](LatticePoint, LatticePoint) { count += 2; });
    }
    require_size(count, "vertices");
    part.vertex_count = static_cast<uint32_t>(count);
}

// The vertices from `begin` to `end`; a part of pairs is written by the range that it begins in.
void write_vertices(const std::vector<LatticePart>& parts, const std::vector<Source>& sources, size_t begin,
                    size_t end, LatticePoint* vertices) {
    for (size_t at = part_of_vertex(parts, begin); at < parts.size() && parts[at].first_vertex < end; ++at) {
        const LatticePart& part = parts[at];
        if (part.is_pairs) {
            LatticePoint* to = vertices + part.first_vertex;
            if (part.first_vertex >= begin)
                sources[at].cut_all([&](LatticePoint a, LatticePoint b) {
                    *to++ = a;
                    *to++ = b;
                });
            continue;
        }
        const size_t first = std::max<size_t>(begin, part.first_vertex);
        const size_t last = std::min<size_t>(end, size_t{part.first_vertex} + part.vertex_count);
        for (size_t vertex = first; vertex < last; ++vertex)
            vertices[vertex] = rounded(sources[at].place(vertex - part.first_vertex));
    }
}

}  // namespace

size_t part_of_vertex(const std::vector<LatticePart>& parts, size_t vertex) {
    const auto starts_after = [](size_t wanted, const LatticePart& part) {
        return wanted < part.first_vertex;
    };
    const auto after = std::upper_bound(parts.begin(), parts.end(), vertex, starts_after);
    return after == parts.begin() ? 0 : static_cast<size_t>(after - parts.begin()) - 1;
}

LatticeParts to_lattice(const TechniqueInput& input, Span<const FeatureReference> polygons,
                        const Lattice& lattice, MemoryCharge& charge, MemoryCharge& working) {
    LatticeParts result;
    const size_t count = part_count(input, polygons);
    require_size(count, "parts");
    working.resize(working.bytes() + count * (sizeof(LatticePart) + sizeof(Source)));
    std::vector<Source> sources;
    result.parts.reserve(count);
    sources.reserve(count);
    list_parts(input, polygons, lattice, result.parts, sources);
    parallel_for(count, parts_at_once, input.threads, [&](size_t begin, size_t end) {
        for (size_t part = begin; part < end; ++part)
            count_vertices(sources[part], result.parts[part]);
    });
    uint64_t total = 0;
    for (LatticePart& part : result.parts) {
        require_size(total, "vertices");
        part.first_vertex = static_cast<uint32_t>(total);
        total += part.vertex_count;
    }
    grow(result.vertices, total, "vertices", charge);
    parallel_for(total, vertices_at_once, input.threads, [&](size_t begin, size_t end) {
        write_vertices(result.parts, sources, begin, end, result.vertices.data());
    });
    return result;
}

}  // namespace decalgl::bvh

#include "technique/static_bvh/lattice_parts.h"

#include <algorithm>
#include <cmath>

#include "decalgl/core/parallel.h"
#include "technique/static_bvh/storage.h"

namespace decalgl::bvh {
namespace {

constexpr size_t parts_at_once = 256;
constexpr size_t vertices_at_once = 1 << 15;

constexpr double low_end = -lattice_margin;
constexpr double high_end = double{lattice_extent} + lattice_margin;

// In quanta, not rounded yet.
struct Place {
    double x;
    double y;
};

bool on_lattice(Place p) {
    return p.x >= low_end && p.x <= high_end && p.y >= low_end && p.y <= high_end;
}

LatticePoint rounded(Place p) {
    return {static_cast<int32_t>(std::lrint(std::clamp(p.x, low_end, high_end))),
            static_cast<int32_t>(std::lrint(std::clamp(p.y, low_end, high_end)))};
}

Place between(Place a, Place b, double t) {
    return t <= 0.0 ? a : t >= 1.0 ? b : Place{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
}

// Narrows the part [first, last] of a way from `start` by `step` to where it is from low_end to high_end.
void narrow(double start, double step, double& first, double& last) {
    if (step == 0.0) {
        if (start < low_end || start > high_end)
            last = -1.0;
        return;
    }
    const double t0 = (low_end - start) / step;
    const double t1 = (high_end - start) / step;
    first = std::max(first, std::min(t0, t1));
    last = std::min(last, std::max(t0, t1));
}

// What is left on the lattice of a segment that leaves it; always cut from the lower end, or the left one of
// a level segment, so that neighbours get the same cuts. Of a ring's edge, what lies beside the lattice moves
// onto its border.
template <typename OnSegment>
void cut(Place a, Place b, bool is_ring, OnSegment on_segment) {
    if (b.y < a.y || (b.y == a.y && b.x < a.x))
        std::swap(a, b);
    double first = 0.0, last = 1.0;
    narrow(a.y, b.y - a.y, first, last);
    double enters = first, leaves = last;
    narrow(a.x, b.x - a.x, enters, leaves);
    const auto keep = [&](double from, double to) {
        on_segment(rounded(between(a, b, from)), rounded(between(a, b, to)));
    };
    if (enters <= leaves)
        keep(enters, leaves);
    if (!is_ring || first > last)
        return;
    const double beside = enters <= leaves ? enters : last;
    if (first < beside)
        keep(first, beside);
    if (enters <= leaves && leaves < last)
        keep(leaves, last);
}

// One part as it comes, and what it becomes.
class Source {
public:
    Source(Span<const double> coordinates, bool is_ring, const Lattice& lattice)
        : coordinates_(coordinates), is_ring_(is_ring), lattice_(&lattice) {}

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

    template <typename OnSegment>
    void cut_all(OnSegment on_segment) const {
        const size_t segments = is_ring_ ? size() : size() - 1;
        for (size_t i = 0; i < segments; ++i)
            cut(place(i), place((i + 1) % size()), is_ring_, on_segment);
    }

private:
    Span<const double> coordinates_;
    bool is_ring_;
    const Lattice* lattice_;
};

size_t part_count(const TechniqueInput& input, Span<const FeatureReference> slots) {
    size_t count = 0;
    for (const FeatureReference& slot : slots) {
        const Features& features = input.layers[slot.layer].features;
        count += static_cast<size_t>(features.feature_offsets[slot.feature + 1] -
                                     features.feature_offsets[slot.feature]);
    }
    return count;
}

void list_parts(const TechniqueInput& input, Span<const FeatureReference> slots, const Lattice& lattice,
                std::vector<LatticePart>& parts, std::vector<Source>& sources) {
    for (size_t slot = 0; slot < slots.size(); ++slot) {
        const Features& features = input.layers[slots[slot].layer].features;
        const bool is_ring = features.kind == FeatureKind::polygons;
        const auto first = static_cast<size_t>(features.feature_offsets[slots[slot].feature]);
        const auto last = static_cast<size_t>(features.feature_offsets[slots[slot].feature + 1]);
        for (size_t part = first; part < last; ++part) {
            parts.push_back({static_cast<uint32_t>(slot), part == first, false, 0, 0});
            sources.emplace_back(features.part(part), is_ring, lattice);
        }
    }
}

void count_vertices(const Source& source, bool is_ring, LatticePart& part) {
    const size_t size = source.size();
    if (size < (is_ring ? 3U : 1U))
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

LatticeParts to_lattice(const TechniqueInput& input, Span<const FeatureReference> slots,
                        const Lattice& lattice, MemoryCharge& charge, MemoryCharge& working) {
    LatticeParts result;
    const size_t count = part_count(input, slots);
    require_size(count, "parts");
    working.resize(working.bytes() + count * (sizeof(LatticePart) + sizeof(Source)));
    std::vector<Source> sources;
    result.parts.reserve(count);
    sources.reserve(count);
    list_parts(input, slots, lattice, result.parts, sources);
    const bool is_ring =
        !slots.empty() && input.layers[slots.front().layer].features.kind == FeatureKind::polygons;
    parallel_for(count, parts_at_once, input.threads, [&](size_t begin, size_t end) {
        for (size_t part = begin; part < end; ++part)
            count_vertices(sources[part], is_ring, result.parts[part]);
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

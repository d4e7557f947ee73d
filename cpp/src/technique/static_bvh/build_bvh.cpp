// From layers to data groups. Everything is built on all cores, and is the same bytes on any number of them.
#include <algorithm>
#include <cmath>

#include "technique/static_bvh/data_group.h"

namespace decalgl::bvh {
namespace {

double widest_reach(const TechniqueInput& input, Span<const Decal> decals) {
    double widest = 0.0;
    for (const Decal& decal : decals)
        widest = std::max(
            widest,
            DecalView{&input.layers[decal.feature.layer - input.first_layer], decal}.widest_half_width());
    return widest;
}

// A ring of n vertices has n edges, a line of n vertices n - 1 segments.
uint64_t segments_of(const Features& features, size_t feature) {
    const uint64_t vertices = features.vertices(feature).size() / 2;
    const auto parts =
        static_cast<uint64_t>(features.feature_offsets[feature + 1] - features.feature_offsets[feature]);
    return features.kind == FeatureKind::polygons ? vertices : vertices - std::min(parts, vertices);
}

// Each feature once, however many decals it has.
void count_features(const TechniqueInput& input, Span<const Decal> decals, PreparedBvh& bvh) {
    std::vector<std::vector<bool>> seen;
    for (const Layer& layer : input.layers)
        seen.emplace_back(layer.features.feature_count(), false);
    for (const Decal& decal : decals) {
        const size_t layer = decal.feature.layer - input.first_layer;
        if (seen[layer][decal.feature.feature])
            continue;
        seen[layer][decal.feature.feature] = true;
        ++bvh.features;
        bvh.segments += segments_of(input.layers[layer].features, decal.feature.feature);
    }
}

}  // namespace

std::unique_ptr<PreparedBvh> build_bvh(const TechniqueInput& input, Progress& progress) {
    auto bvh = std::make_unique<PreparedBvh>();
    bvh->charge = MemoryCharge(input.memory, "static_bvh: prepared", 0);
    bvh->options = input.bvh;
    const std::vector<Decal> decals = decals_of(input.layers, input.first_layer);
    bvh->lattice = Lattice::over(input.bounds, input.positions, widest_reach(input, decals));
    count_features(input, decals, *bvh);
    const std::vector<DecalRun> runs = cut_into_runs(input, decals);
    for (size_t i = 0; i < runs.size(); ++i) {
        const auto count = static_cast<double>(runs.size());
        add_group(input, runs[i], *bvh, {&progress, double(i) / count, double(i + 1) / count});
    }
    progress.report(1.0);
    return bvh;
}

PreparedCounts PreparedBvh::counts() const {
    // Half widths are held in float32, so a wide line's border may lie further off than its vertices.
    double quantum = lattice.quantum;
    for (const DecalGroup& group : groups)
        quantum = std::max(quantum, lattice.quantum * std::ldexp(double{group.widest}, -22));
    return {features, segments, pieces, charge.bytes(), quantum};
}

}  // namespace decalgl::bvh

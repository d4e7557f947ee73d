// From layers to data groups. Everything is built on all cores, and is the same bytes on any number of them.
#include <algorithm>
#include <cmath>

#include "technique/static_bvh/data_group.h"
#include "technique/static_bvh/walk_length.h"

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
    bvh->options = input.bvh;
    bvh->rules = rules_of(input);
    bvh->sources = std::make_shared<const LayerSources>(input);
    bvh->bounds = input.bounds;
    bvh->positions = input.positions;
    bvh->threads = input.threads;
    const std::vector<Decal> decals = decals_of(input.layers, input.first_layer, Hidden::kept);
    bvh->lattice = Lattice::over(input.bounds, input.positions, widest_reach(input, decals));
    count_features(input, decals, *bvh);
    const std::vector<DecalRun> runs = cut_into_runs(input, decals);
    for (size_t i = 0; i < runs.size(); ++i) {
        const auto count = static_cast<double>(runs.size());
        bvh->groups.push_back(
            build_group(input, runs[i], bvh->lattice, {&progress, double(i) / count, double(i + 1) / count}));
        bvh->longest_walk = std::max(bvh->longest_walk, longest_walk(bvh->groups.back(), input.threads));
    }
    bvh->count_slots();
    progress.report(1.0);
    return bvh;
}

void PreparedBvh::count_slots() {
    uint32_t slots = 0;
    pieces = 0;
    for (DecalGroup& group : groups) {
        group.first_slot = slots;
        slots += static_cast<uint32_t>(group.slots.size());
        pieces += group.segments.size() + group.exteriors.size() + group.interiors.size();
    }
}

FeatureReference PreparedBvh::feature(uint32_t id) const {
    const auto after =
        std::upper_bound(groups.begin(), groups.end(), id,
                         [](uint32_t slot, const DecalGroup& group) { return slot < group.first_slot; });
    const DecalGroup& group = *(after - 1);
    return group.slots[id - group.first_slot].feature;
}

bool PreparedBvh::shows_anything() const {
    return std::any_of(groups.begin(), groups.end(), [](const DecalGroup& group) { return group.has_shown; });
}

PreparedCounts PreparedBvh::counts() const {
    // Half widths are held in float32, so a wide line's border may lie further off than its vertices.
    double quantum = lattice.quantum;
    uint64_t bytes = 0;
    for (const DecalGroup& group : groups) {
        quantum = std::max(quantum, lattice.quantum * std::ldexp(double{group.widest}, -22));
        bytes += group.charge->bytes();
    }
    return {features, segments, pieces, bytes, quantum};
}

}  // namespace decalgl::bvh

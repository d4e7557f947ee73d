#include "technique/loops/hierarchy.h"

#include "technique/loops/half_float.h"

namespace decalgl::loops {

double Hierarchy::error_of(uint32_t point) const {
    const auto half = static_cast<uint16_t>(activations[point].error_and_radius);
    return half_to_double(half) / length_scale * lattice.quantum;
}

Hierarchy build_hierarchy(Span<const Layer> layers, const Bounds& bounds, const PositionGrid& positions,
                          const Heightfield& terrain, double reach, const LoopsOptions& options, unsigned threads,
                          Progress& progress) {
    Hierarchy hierarchy;
    hierarchy.lattice = Lattice::over(bounds, positions, reach);
    const Lattice& lattice = hierarchy.lattice;
    Chains chains;
    hierarchy.first_features.push_back(0);
    for (const Layer& layer : layers) {
        add_chains(layer, hierarchy.first_features.back(), lattice, threads, chains);
        hierarchy.first_features.push_back(hierarchy.first_features.back() +
                                           static_cast<uint32_t>(layer.features.feature_count()));
    }
    hierarchy.vertices = chains.points.size();
    progress.report(0.1);
    LargeArray<uint32_t> numbers;
    const Locations locations(chains.points, numbers, threads);
    const NodedChains noded = node_junctions(chains, locations, numbers, threads);
    progress.report(0.3);
    hierarchy.arcs = make_arcs(chains, noded, locations, hierarchy.first_features.back(), threads);
    hierarchy.chain_features = chains.features;
    progress.report(0.4);
    hierarchy.refinement = refine_arcs(hierarchy.arcs, lattice, options, threads);
    progress.report(0.5);
    const Dependencies dependencies = find_dependencies(hierarchy.arcs, locations, hierarchy.refinement, threads);
    hierarchy.needs = dependencies.needs.size();
    progress.report(0.65);
    const Ground ground(terrain, lattice, threads);
    hierarchy.heights = ground.everywhere();
    hierarchy.activations = saturate(hierarchy.arcs, hierarchy.refinement, dependencies, ground, threads);
    progress.report(0.75);
    return hierarchy;
}

Features simplified(const Hierarchy& hierarchy, size_t layer, FeatureKind kind, double tolerance) {
    const Arcs& arcs = hierarchy.arcs;
    const uint32_t first = hierarchy.first_features[layer], end = hierarchy.first_features[layer + 1];
    std::vector<double> coordinates;
    std::vector<int64_t> parts = {0}, features = {0};
    uint32_t feature = first;
    const auto close_features = [&](uint32_t up_to) {
        for (; feature < up_to; ++feature)
            features.push_back(static_cast<int64_t>(parts.size()) - 1);
    };
    for (size_t chain = 0; chain < hierarchy.chain_features.size(); ++chain) {
        if (hierarchy.chain_features[chain] < first || hierarchy.chain_features[chain] >= end)
            continue;
        close_features(hierarchy.chain_features[chain]);
        const size_t before = coordinates.size();
        for (uint64_t i = arcs.chain_offsets[chain]; i < arcs.chain_offsets[chain + 1]; ++i) {
            const uint32_t arc = arcs.chain_arcs[i] / 2, size = arcs.size_of(arc);
            const bool reversed = arcs.chain_arcs[i] % 2 == 1;
            // The end is where the next arc begins; a line's last arc has it.
            const bool is_last = i + 1 == arcs.chain_offsets[chain + 1] && kind == FeatureKind::lines;
            for (uint32_t k = 0; k + (is_last ? 0 : 1) < size; ++k) {
                const uint32_t p = arcs.begin(arc) + (reversed ? size - 1 - k : k);
                if (!(hierarchy.error_of(p) > tolerance))
                    continue;
                coordinates.push_back(hierarchy.lattice.x_of(arcs.points[p]));
                coordinates.push_back(hierarchy.lattice.y_of(arcs.points[p]));
            }
        }
        if (coordinates.size() - before < (kind == FeatureKind::polygons ? 6 : 4))
            coordinates.resize(before);
        else
            parts.push_back(static_cast<int64_t>(coordinates.size() / 2));
    }
    close_features(end);
    return Features::own(kind, std::move(coordinates), std::move(parts), std::move(features));
}

}  // namespace decalgl::loops

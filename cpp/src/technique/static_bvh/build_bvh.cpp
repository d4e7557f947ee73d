// From layers to data groups, each with a grid, its cells' trees and, for polygons, quad-trees. Everything is
// built on all cores, and is the same bytes on any number of them.
#include <algorithm>
#include <cmath>

#include "decalgl/core/error.h"
#include "technique/static_bvh/line_group.h"
#include "technique/static_bvh/polygon_group.h"
#include "technique/static_bvh/prepared_bvh.h"
#include "technique/static_bvh/walk_length.h"

namespace decalgl::bvh {
namespace {

// Layers [first, last) of the input.
struct LayerRun {
    size_t first;
    size_t last;
};

std::vector<LayerRun> cut_into_groups(const TechniqueInput& input) {
    std::vector<LayerRun> runs;
    for (size_t layer = 0; layer < input.layers.size(); ++layer) {
        const bool joins = input.bvh.passes == PassGrouping::kind && layer > 0 &&
                           input.layers[layer].features.kind == input.layers[layer - 1].features.kind;
        if (joins)
            runs.back().last = layer + 1;
        else
            runs.push_back({layer, layer + 1});
    }
    return runs;
}

double widest_reach(const TechniqueInput& input) {
    double widest = 0.0;
    for (const Layer& layer : input.layers)
        for (const double width : layer.stroke.widths)
            widest = std::max(widest, 0.5 * width);
    return widest;
}

// A ring of n vertices has n edges, a line of n vertices n - 1 segments.
uint64_t segments_of(const Features& features, size_t feature) {
    const uint64_t vertices = features.vertices(feature).size() / 2;
    const auto parts =
        static_cast<uint64_t>(features.feature_offsets[feature + 1] - features.feature_offsets[feature]);
    return features.kind == FeatureKind::polygons ? vertices : vertices - std::min(parts, vertices);
}

// Features that are seen at all, topmost first, by their layer's place in the input; sets the group's styles.
Slots collect_slots(const TechniqueInput& input, const LayerRun& run, PreparedBvh& bvh, DecalGroup& group) {
    Slots slots;
    group.kind = input.layers[run.first].features.kind;
    for (size_t l = run.last; l-- > run.first;) {
        const Layer& layer = input.layers[l];
        for (size_t rank = layer.features.feature_count(); rank-- > 0;) {
            const size_t feature = layer.feature_at(rank);
            const uint8_t* color =
                group.kind == FeatureKind::lines ? layer.stroke.color(feature) : layer.fill.color(feature);
            if (color[3] == 0)
                continue;
            const double width = group.kind == FeatureKind::lines ? layer.stroke.width(feature) : 0.0;
            const auto half_width = static_cast<float>(0.5 * width / bvh.lattice.quantum);
            group.styles.push_back({{color[0], color[1], color[2], color[3]}, half_width});
            group.widest = std::max(group.widest, half_width);
            group.has_translucency |= color[3] != 255;
            slots.push_back({static_cast<uint32_t>(l), static_cast<uint32_t>(feature)});
            bvh.segments += segments_of(layer.features, feature);
        }
    }
    return slots;
}

// Along a curve, segments come in no order in which translucent lines could be laid over each other.
void require_drawable(const BvhOptions& options, const DecalGroup& group, const std::string& layer) {
    if (group.kind == FeatureKind::lines && group.has_translucency &&
        options.segment_order == SegmentOrder::hilbert && options.composition == Composition::order)
        throw Error(ErrorKind::unsupported,
                    "layer '" + layer +
                        "' has translucent lines, which cannot be drawn in order while segment_order is "
                        "\"hilbert\"; use segment_order=\"importance\", composition=\"nearest\" or opaque "
                        "colours");
}

void add_group(const TechniqueInput& input, const LayerRun& run, PreparedBvh& bvh, const Stage& stage) {
    DecalGroup group;
    const Slots slots = collect_slots(input, run, bvh, group);
    if (slots.empty())
        return;
    require_drawable(input.bvh, group, input.layers[run.first].name);
    MemoryCharge working(input.memory, "static_bvh: working memory", 0);
    bvh.charge.resize(bvh.charge.bytes() + slots.size() * (sizeof(Style) + sizeof(FeatureReference)));
    LatticeParts parts = to_lattice(input, slots, bvh.lattice, bvh.charge, working);
    const auto build = group.kind == FeatureKind::lines ? build_lines : build_polygons;
    build(input, std::move(parts), bvh.lattice, group, bvh.charge, stage);
    group.first_slot = static_cast<uint32_t>(bvh.slots.size());
    for (const FeatureReference& slot : slots)
        bvh.slots.push_back({input.first_layer + slot.layer, slot.feature});
    bvh.pieces += group.segments.size() + group.exteriors.size() + group.interiors.size();
    bvh.longest_walk = std::max(bvh.longest_walk, longest_walk(group, input.threads));
    bvh.groups.push_back(std::move(group));
}

}  // namespace

std::unique_ptr<PreparedBvh> build_bvh(const TechniqueInput& input, Progress& progress) {
    auto bvh = std::make_unique<PreparedBvh>();
    bvh->charge = MemoryCharge(input.memory, "static_bvh: prepared", 0);
    bvh->options = input.bvh;
    bvh->lattice = Lattice::over(input.bounds, input.positions, widest_reach(input));
    const std::vector<LayerRun> runs = cut_into_groups(input);
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
    return {slots.size(), segments, pieces, charge.bytes(), quantum};
}

}  // namespace decalgl::bvh

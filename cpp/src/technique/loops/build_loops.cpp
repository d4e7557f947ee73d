// From layers to what the shaders read.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "decalgl/core/error.h"
#include "decalgl/core/parallel.h"
#include "technique/loops/loops_layout.h"
#include "technique/loops/prepared_loops.h"

namespace decalgl::loops {
namespace {

constexpr size_t most_slots = size_t{1} << (32 - GROUP_COUNT_BITS);

void refuse_unless(bool is_drawn, const Layer& layer, const char* what) {
    if (!is_drawn)
        throw Error(ErrorKind::unsupported, "layer '" + layer.name + "': technique 'loops' draws no " + what +
                                                "; leave it out, or use technique 'static'");
}

// A round line of one colour, and even fills: the rest would have to be simplified as well.
void refuse_styles(const Layer& layer) {
    for (const Stroke* stroke : {&layer.stroke, &layer.casing}) {
        if (stroke->empty())
            continue;
        for (const StrokeStyle& style : stroke->styles) {
            refuse_unless(style.corner == Corner::round || layer.features.kind == FeatureKind::polygons,
                          layer, "corners that are not round");
            refuse_unless(style.cap == Cap::round || layer.features.kind == FeatureKind::polygons, layer,
                          "caps that are not round");
            refuse_unless(style.slope_correction == SlopeCorrection::none, layer, "slope correction");
            refuse_unless(style.pattern.period == 0.0, layer, "dashes and other patterns");
            refuse_unless(style.bands.empty(), layer, "bands of colour");
        }
    }
    refuse_unless(layer.stroke.empty() || layer.outline_mode == OutlineMode::normal, layer,
                  "inset or offset outlines");
    for (const Hatch& hatch : layer.fill.hatches)
        refuse_unless(layer.fill.empty() || hatch.spacing == 0.0, layer, "hatches");
}

double widest_reach(Span<const Layer> layers, uint32_t first_layer, Span<const Decal> decals) {
    double widest = 0.0;
    for (const Decal& decal : decals)
        widest = std::max(widest, DecalView{&layers[decal.feature.layer - first_layer], decal}.half_width());
    return widest;
}

Style style_of(const DecalView& decal, double quantum) {
    const uint8_t* rgba = decal.color();
    const auto half_width = static_cast<float>(decal.half_width() / quantum);
    // A stroke stays one, however thin.
    return {uint32_t{rgba[0]} | uint32_t{rgba[1]} << 8 | uint32_t{rgba[2]} << 16 | uint32_t{rgba[3]} << 24,
            decal.decal.is_stroke() ? std::max(half_width, 1e-6F) : 0.0F};
}

// All primitives of all slots, topmost first.
class ItemMaker {
public:
    ItemMaker(const Hierarchy& hierarchy, LinePrimitives primitives)
        : hierarchy_(hierarchy), primitives_(primitives) {}

    void add_fill(uint32_t slot, size_t feature, Items& items) const {
        const Arcs& arcs = hierarchy_.arcs;
        const Refinement& refinement = hierarchy_.refinement;
        for (const uint32_t arc : arcs.fill_of(feature))
            for (uint32_t p = arcs.begin(arc) + 1; p + 1 < arcs.end(arc); ++p)
                if (doubled_area(arcs.points[refinement.left[p]], arcs.points[p],
                                 arcs.points[refinement.right[p]]) != 0)
                    items.push_back({slot, p});
    }

    void add_stroke(uint32_t slot, size_t feature, Items& items) const {
        const Arcs& arcs = hierarchy_.arcs;
        for (const uint32_t arc : arcs.stroke_of(feature)) {
            for (uint32_t p = arcs.begin(arc) + 1; p + 1 < arcs.end(arc); ++p)
                items.push_back({slot, p});
            if (primitives_ == LinePrimitives::segments || arcs.size_of(arc) == 2)
                for (uint32_t p = arcs.begin(arc); p + 1 < arcs.end(arc); ++p)
                    items.push_back({slot, p | EDGE_FLAG | (is_from_next(p) ? EDGE_FROM_NEXT : 0)});
        }
    }

private:
    // Whether the edge from p on comes up with the vertex after it.
    bool is_from_next(uint32_t p) const { return hierarchy_.refinement.left[p + 1] == p; }

    const Hierarchy& hierarchy_;
    LinePrimitives primitives_;
};

Items make_items(const Hierarchy& hierarchy, LinePrimitives primitives, const Slots& slots,
                 unsigned threads) {
    constexpr size_t grain = 1024;
    const ItemMaker maker(hierarchy, primitives);
    std::vector<Items> blocks(block_count(slots.decals.size(), grain));
    parallel_for(slots.decals.size(), grain, threads, [&](size_t begin, size_t end) {
        for (size_t slot = begin; slot < end; ++slot)
            if (slots.decals[slot].is_stroke())
                maker.add_stroke(static_cast<uint32_t>(slot), slots.features[slot], blocks[begin / grain]);
            else
                maker.add_fill(static_cast<uint32_t>(slot), slots.features[slot], blocks[begin / grain]);
    });
    Items items;
    size_t count = 0;
    for (const Items& block : blocks)
        count += block.size();
    items.reserve(count);
    for (const Items& block : blocks)
        items.insert(items.end(), block.begin(), block.end());
    return items;
}

LargeArray<Base> make_bases(const Hierarchy& hierarchy, unsigned threads) {
    const Refinement& refinement = hierarchy.refinement;
    LargeArray<Base> bases(hierarchy.arcs.points.size());
    parallel_for(bases.size(), 1 << 14, threads, [&](size_t begin, size_t end) {
        for (auto p = static_cast<uint32_t>(begin); p < end; ++p) {
            if (!refinement.is_splitter(p)) {
                bases[p] = {p, p};
                continue;
            }
            const uint32_t left = refinement.left[p], right = refinement.right[p];
            bases[p] = {left | (refinement.parents[p] == right ? BASE_FROM_RIGHT : 0) |
                            (left + 1 == p ? BASE_LEFT_EDGE : 0) | (p + 1 == right ? BASE_RIGHT_EDGE : 0),
                        right};
        }
    });
    return bases;
}

// Of all features that are drawn, each once.
uint64_t count_segments(Span<const Layer> layers, Span<const Decal> decals, uint32_t first_layer) {
    std::vector<std::vector<bool>> seen;
    for (const Layer& layer : layers)
        seen.emplace_back(layer.features.feature_count(), false);
    uint64_t segments = 0;
    for (const Decal& decal : decals) {
        const size_t layer = decal.feature.layer - first_layer;
        std::vector<bool>::reference is_seen = seen[layer][decal.feature.feature];
        if (is_seen)
            continue;
        is_seen = true;
        const Features& features = layers[layer].features;
        const uint64_t vertices = features.vertices(decal.feature.feature).size() / 2;
        const auto parts = static_cast<uint64_t>(features.feature_offsets[decal.feature.feature + 1] -
                                                 features.feature_offsets[decal.feature.feature]);
        segments += features.kind == FeatureKind::polygons ? vertices : vertices - std::min(parts, vertices);
    }
    return segments;
}

// The paper's index.
Bvh make_bvh(const LoopsOptions& options, const Hierarchy& hierarchy, const Slots& slots, unsigned threads,
             MemoryCharge& charge, Progress& progress) {
    Bvh bvh;
    bvh.primitives = options.primitives;
    charge.resize(charge.bytes() + hierarchy.arcs.points.size() * sizeof(Base));
    std::vector<float> half_widths;
    for (const Style& style : slots.styles)
        half_widths.push_back(style.half_width);
    Items items = make_items(hierarchy, bvh.primitives, slots, threads);
    bvh.items = items.size();
    const LoopsBvh settings = fitted(*options.bvh, items.size());
    Tree tree = build_tree({&hierarchy, half_widths, bvh.primitives}, std::move(items),
                           hierarchy.lattice.terrain, settings, threads, charge, progress);
    bvh.words = std::move(tree.words);
    bvh.counts = tree.counts;
    bvh.most_lists = tree.most_lists;
    bvh.bases = make_bases(hierarchy, threads);
    return bvh;
}

Slots make_slots(const TechniqueInput& input, const std::vector<Decal>& upwards, const Hierarchy& hierarchy) {
    const std::vector<Decal> decals(upwards.rbegin(), upwards.rend());
    std::vector<Style> styles;
    std::vector<uint32_t> features, numbers(decals.size());
    for (const Decal& decal : decals) {
        const uint32_t layer = decal.feature.layer - input.first_layer;
        styles.push_back(style_of({&input.layers[layer], decal}, hierarchy.lattice.quantum));
        features.push_back(hierarchy.first_features[layer] + decal.feature.feature);
    }
    std::iota(numbers.rbegin(), numbers.rend(), 0);
    Slots slots;
    slots.decals = decals;
    slots.features = std::move(features);
    slots.styles = std::move(styles);
    slots.upwards = std::move(numbers);
    return slots;
}

}  // namespace

std::unique_ptr<PreparedLoops> build_loops(const TechniqueInput& input, Progress& progress) {
    LoopsChoice choice;
    if (const auto* given = dynamic_cast<const LoopsChoice*>(input.layers[0].technique.options.get()))
        choice = *given;
    validate(choice.options);
    validate(choice.detail);
    for (const Layer& layer : input.layers)
        refuse_styles(layer);
    const std::vector<Decal> decals = decals_of(input.layers, input.first_layer, Hidden::kept);
    if (decals.size() > most_slots)
        throw Error(ErrorKind::memory, "technique 'loops' draws at most " + std::to_string(most_slots) +
                                           " features in a pass; use technique 'static'");
    auto index = std::make_shared<LoopsIndex>();
    index->charge = MemoryCharge(input.memory, "loops: prepared", 0);
    index->first_layer = input.first_layer;
    std::vector<OutlineOrder> outlines;
    for (const Layer& layer : input.layers)
        outlines.push_back(layer.outline_order);
    index->outlines = std::move(outlines);
    index->segments = count_segments(input.layers, decals, input.first_layer);
    Hierarchy hierarchy = build_hierarchy(input.layers, input.bounds, input.positions, *input.terrain,
                                          widest_reach(input.layers, input.first_layer, decals),
                                          choice.options, input.threads, progress);
    index->charge.resize(hierarchy.arcs.points.size() *
                         (sizeof(LatticePoint) + sizeof(Activation) + sizeof(Step)));
    index->lattice = hierarchy.lattice;
    index->heights = hierarchy.heights;
    index->needs = hierarchy.needs;
    index->steps = steps_of(hierarchy.arcs, hierarchy.refinement, input.threads);
    auto slots = std::make_shared<Slots>(make_slots(input, decals, hierarchy));
    if (choice.options.bvh)
        index->bvh = make_bvh(choice.options, hierarchy, *slots, input.threads, index->charge, progress);
    index->arcs = kept(std::move(hierarchy.arcs));
    index->activations = std::move(hierarchy.activations);
    slots->reach_along(*index);
    progress.report(1.0);
    return std::make_unique<PreparedLoops>(std::move(index), std::move(slots), choice.detail);
}

uint64_t LoopsIndex::bytes() const {
    return arcs.points.size_bytes() + activations.size_bytes() + steps.size_bytes() +
           (bvh ? bvh->bases.size_bytes() + bvh->words.size_bytes() : 0);
}

PreparedCounts PreparedLoops::counts() const {
    return {slots_->decals.size(), index_->segments,
            index_->bvh ? index_->bvh->counts.references : index_->steps.size(), index_->bytes(),
            index_->lattice.quantum};
}

}  // namespace decalgl::loops

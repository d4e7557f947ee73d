// Layers prepared for LOOPS: arcs and when their vertices are active, and how slots look.
//
//     LoopsIndex   stays whatever the layers look like        Slots   what is drawn, topmost first
//     Bvh          the paper's index, where it was chosen; for the shaders (loops_layout.h)
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "decalgl/technique/loops_detail.h"
#include "decalgl/technique/loops_options.h"
#include "decalgl/technique/technique.h"
#include "technique/loops/active_arcs.h"
#include "technique/loops/tree_builder.h"

namespace decalgl::loops {

// Two numbers of points; flags in the first.
struct Base {
    uint32_t left;
    uint32_t right;
};

struct Style {
    uint32_t color;    // R, G, B, A from the lowest byte on
    float half_width;  // quanta; of fills 0

    bool is_fill() const { return half_width == 0.0F; }
    bool is_shown() const { return color >> 24 != 0; }
    bool is_opaque() const { return color >> 24 == 255; }
};
static_assert(sizeof(Base) == 8 && sizeof(Style) == 8, "RG32 texels");

struct Bvh {
    LoopsBvh settings;
    LinePrimitives primitives = LinePrimitives::triangles;
    LargeArray<Base> bases;
    Tree tree;
    uint64_t items = 0;  // primitives of all slots, before the tree refers to some more than once
};

struct LoopsIndex {
    Lattice lattice;
    GroundRange heights;
    Arcs arcs;
    LargeArray<Activation> activations;
    LargeArray<Step> steps;
    std::optional<Bvh> bvh;
    uint32_t first_layer = 0;
    std::vector<uint32_t> first_features;  // of each layer, and how many there are in all
    std::vector<OutlineOrder> outlines;    // of each layer
    uint64_t features = 0;
    uint64_t segments = 0;
    uint64_t needs = 0;
    MemoryCharge charge;
};

// The topmost first.
struct Slots {
    std::vector<Decal> decals;
    std::vector<Style> styles;
    std::vector<uint32_t> features;  // as arcs count them
    std::vector<float> reaches;      // of arcs: half the width of the widest stroke along each, metres

    // Fills in what follows from decals and styles. `arcs`: the index has them once all is prepared.
    void complete(const LoopsIndex& index, const Arcs& arcs);
};

class PreparedLoops : public Prepared {
public:
    PreparedLoops(std::shared_ptr<const LoopsIndex> index, std::shared_ptr<const Slots> slots,
                  const LoopsDetail& detail)
        : index_(std::move(index)), slots_(std::move(slots)), detail_(detail) {}

    const std::shared_ptr<const LoopsIndex>& index() const { return index_; }
    const std::shared_ptr<const Slots>& slots() const { return slots_; }
    const LoopsDetail& detail() const { return detail_; }

    PreparedCounts counts() const override;
    FeatureReference feature(uint32_t id) const override { return slots_->decals[id].feature; }
    // With all details, whatever the view leaves out.
    std::vector<FeatureReference> query(const SeenPoint& point) const override;
    bool shows_anything() const override;
    LayerLook look_of(uint32_t layer, size_t features) const override;
    // With other colours, widths, draw order and level of detail; the paper's index keeps widths and order.
    std::shared_ptr<const Prepared> restyled(Span<const LayerLook> looks,
                                             const MemoryAccount& memory) const override;
    // These throw Error(unsupported).
    void save(ArchiveWriter& archive, const std::string& prefix) const override;
    std::shared_ptr<const Prepared> edited(const LayerEdit& edit, const MemoryAccount& memory) const override;

private:
    std::shared_ptr<const LoopsIndex> index_;
    std::shared_ptr<const Slots> slots_;
    LoopsDetail detail_;
};

// Throws Error(memory), Error(unsupported) for styles that LOOPS does not draw, Error(input), Error(cancelled).
std::unique_ptr<PreparedLoops> build_loops(const TechniqueInput& input, Progress& progress);

}  // namespace decalgl::loops

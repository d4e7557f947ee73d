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
    LinePrimitives primitives = LinePrimitives::triangles;
    SharedArray<Base> bases;
    SharedArray<uint32_t> words;
    TreeCounts counts;
    uint32_t most_lists = 1;  // that a position has
    uint64_t items = 0;       // primitives of all slots, before the tree refers to some more than once
};

struct LoopsIndex {
    Lattice lattice;
    GroundRange heights;
    KeptArcs arcs;
    SharedArray<Activation> activations;
    SharedArray<Step> steps;
    std::optional<Bvh> bvh;
    uint32_t first_layer = 0;
    SharedArray<OutlineOrder> outlines;  // of each layer
    uint64_t segments = 0;
    uint64_t needs = 0;
    MemoryCharge charge;  // nothing where the arrays lie in a file

    uint64_t bytes() const;
};

// Numbered as they lay when they were prepared, the topmost first. Copies share what they have in common.
struct Slots {
    SharedArray<Decal> decals;
    SharedArray<uint32_t> features;  // as arcs count them
    SharedArray<Style> styles;
    SharedArray<uint32_t> upwards;  // how they lie over each other now
    SharedArray<float> reaches;     // of arcs: half the width of the widest stroke along each, metres

    // Fills in the reaches.
    void reach_along(const LoopsIndex& index);
    // Whether others differ in their colours alone.
    bool lie_as(const Slots& others) const {
        return reaches.data() == others.reaches.data() && upwards.data() == others.upwards.data();
    }
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
    void save(ArchiveWriter& archive, const std::string& prefix) const override;
    // Throws Error(unsupported).
    std::shared_ptr<const Prepared> edited(const LayerEdit& edit, const MemoryAccount& memory) const override;

private:
    std::shared_ptr<const LoopsIndex> index_;
    std::shared_ptr<const Slots> slots_;
    LoopsDetail detail_;
};

// Throws Error(memory), Error(unsupported) for styles that LOOPS does not draw, Error(input), Error(cancelled).
std::unique_ptr<PreparedLoops> build_loops(const TechniqueInput& input, Progress& progress);

// What PreparedLoops::save wrote; throws Error(file) for anything else.
std::unique_ptr<PreparedLoops> open_loops(const ArchiveReader& archive, const std::string& prefix);

}  // namespace decalgl::loops

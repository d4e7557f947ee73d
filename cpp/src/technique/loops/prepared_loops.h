// Layers prepared for LOOPS: flat arrays for the shaders (loops_layout.h), and how slots look.
#pragma once

#include <memory>
#include <vector>

#include "decalgl/technique/loops_detail.h"
#include "decalgl/technique/loops_options.h"
#include "decalgl/technique/technique.h"
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
};
static_assert(sizeof(Base) == 8 && sizeof(Style) == 8, "RG32 texels");

// What stays whatever the layers look like.
struct LoopsIndex {
    Lattice lattice;
    GroundRange heights;
    LoopsBvh settings;
    LinePrimitives primitives = LinePrimitives::triangles;
    LargeArray<LatticePoint> points;
    LargeArray<Base> bases;
    LargeArray<Activation> activations;
    Tree tree;
    std::vector<Style> styles;  // topmost first, as the rest of these
    std::vector<FeatureReference> slots;
    uint64_t features = 0;
    uint64_t segments = 0;
    uint64_t items = 0;  // primitives of all slots, before the tree refers to some more than once
    uint64_t needs = 0;
    MemoryCharge charge;
};

class PreparedLoops : public Prepared {
public:
    PreparedLoops(std::shared_ptr<const LoopsIndex> index, const LoopsDetail& detail)
        : index_(std::move(index)), detail_(detail) {}

    const std::shared_ptr<const LoopsIndex>& index() const { return index_; }
    const LoopsDetail& detail() const { return detail_; }

    PreparedCounts counts() const override;
    FeatureReference feature(uint32_t id) const override { return index_->slots[id]; }
    // With all details, whatever the view leaves out.
    std::vector<FeatureReference> query(const SeenPoint& point) const override;
    bool shows_anything() const override { return true; }
    // These throw Error(unsupported).
    void save(ArchiveWriter& archive, const std::string& prefix) const override;
    LayerLook look_of(uint32_t layer, size_t features) const override;
    std::shared_ptr<const Prepared> restyled(Span<const LayerLook> looks,
                                             const MemoryAccount& memory) const override;
    std::shared_ptr<const Prepared> edited(const LayerEdit& edit, const MemoryAccount& memory) const override;

private:
    std::shared_ptr<const LoopsIndex> index_;
    LoopsDetail detail_;
};

// Throws Error(memory), Error(unsupported) for styles that LOOPS does not draw, Error(input), Error(cancelled).
std::unique_ptr<PreparedLoops> build_loops(const TechniqueInput& input, Progress& progress);

}  // namespace decalgl::loops

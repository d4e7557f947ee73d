// Prepared static decals in the structures of Zechmeister and Thöny, as flat arrays (bvh_layout.h).
//
// Each data group has a decal grid of its own and is drawn in a pass of its own, from the bottom to the top.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "decalgl/core/large_array.h"
#include "decalgl/technique/technique.h"
#include "technique/static_bvh/bvh_layout.h"
#include "technique/static_bvh/decal_grid.h"

namespace decalgl::bvh {

// What a cell's tree and list of objects begin with.
struct CellStart {
    uint32_t node;
    uint32_t object;
};

// Two places in a group's vertices, the lower left end first.
struct Segment {
    uint32_t a;
    uint32_t b;
};

struct Exterior {
    uint32_t subtree;         // of the feature's first ring, or NO_SUBTREE
    uint32_t slot;            // in the group
    uint32_t first_interior;  // its other rings in this cell
    uint32_t interior_count;
};

struct QuadLink {
    uint32_t kind_and_count;
    uint32_t first;

    uint32_t kind() const { return kind_and_count & QUAD_KIND_MASK; }
    uint32_t count() const { return kind_and_count >> QUAD_COUNT_SHIFT; }
};

// An edge of a ring, upwards, and the rows where it counts in one leaf.
struct LeafEdge {
    uint32_t a;  // or CLOSING_EDGE
    uint32_t b;
    int32_t first_row;
    int32_t end_row;
};

struct Style {
    std::array<uint8_t, 4> color;
    float half_width;  // quanta; 0 for polygons
};

static_assert(sizeof(LatticeBox) == 16 && sizeof(Exterior) == 16 && sizeof(LeafEdge) == 16, "RGBA32 texels");
static_assert(sizeof(CellStart) == 8 && sizeof(Segment) == 8 && sizeof(QuadLink) == 8 && sizeof(Style) == 8,
              "RG32 texels");

struct QuadTrees {
    LargeArray<LatticeBox> boxes;
    LargeArray<QuadLink> links;
    LargeArray<LeafEdge> edges;
};

struct DecalGroup {
    FeatureKind kind = FeatureKind::lines;
    uint32_t first_slot = 0;  // of the whole index
    std::vector<Style> styles;
    bool has_translucency = false;
    float widest = 0.0F;  // half width of a line, quanta

    DecalGrid grid;
    LargeArray<CellStart> cells;
    LargeArray<LatticeBox> nodes;
    LargeArray<LatticePoint> vertices;

    LargeArray<Segment> segments;
    LargeArray<uint32_t> owners;

    LargeArray<Exterior> exteriors;
    LargeArray<uint32_t> interiors;
    QuadTrees quads;

    uint32_t objects_in(uint32_t cell) const { return cells[cell + 1].object - cells[cell].object; }
};

class PreparedBvh : public Prepared {
public:
    PreparedCounts counts() const override;
    FeatureReference feature(uint32_t id) const override { return slots[id]; }
    std::vector<FeatureReference> query(double x, double y) const override;
    // Throws Error(unsupported): the structures are there to be compared with.
    void save(ArchiveWriter& archive, const std::string& prefix) const override;
    bool shows_anything() const override { return true; }
    // Throws Error(unsupported) too.
    LayerLook look_of(uint32_t layer, size_t features) const override;
    std::shared_ptr<const Prepared> edited(const LayerEdit& edit, const MemoryAccount& memory) const override;
    std::shared_ptr<const Prepared> restyled(Span<const LayerLook> looks,
                                             const MemoryAccount& memory) const override;

    Lattice lattice;
    BvhOptions options;
    std::vector<DecalGroup> groups;       // bottom to top
    std::vector<FeatureReference> slots;  // group by group, in each topmost first
    uint64_t segments = 0;
    uint64_t pieces = 0;
    uint64_t longest_walk = 0;
    MemoryCharge charge;
};

// Throws Error(memory) where the index would not fit into the budget or its arrays, Error(unsupported) for
// options that exclude each other, Error(cancelled).
std::unique_ptr<PreparedBvh> build_bvh(const TechniqueInput& input, Progress& progress);

}  // namespace decalgl::bvh

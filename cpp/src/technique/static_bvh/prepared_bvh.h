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

// Two places in a group's vertices, the lower left end first; PLAIN_END may be set in either.
struct Segment {
    uint32_t a;
    uint32_t b;

    uint32_t first() const { return a & ~PLAIN_END; }
    uint32_t second() const { return b & ~PLAIN_END; }
};

struct Exterior {
    uint32_t subtree;         // of the feature's first ring, or NO_SUBTREE
    uint32_t slot;            // in the group, or NO_SLOT
    uint32_t first_interior;  // its other rings in this cell
    uint32_t interior_count;
};

// An object of a group of fills and strokes.
struct Object {
    uint32_t place;     // an exterior; with STROKE_OBJECT a segment
    uint32_t exterior;  // of a segment: that of its feature in the same cell, or NO_EXTERIOR

    bool is_stroke() const { return (place & STROKE_OBJECT) != 0; }
    uint32_t segment() const { return place & ~STROKE_OBJECT; }
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
    float half_width;  // quanta; of fills 0, of strokes without any width below 0
    uint32_t look;     // where it begins
    uint32_t unused;
};

// A texel of the looks.
using LookTexel = std::array<uint32_t, 4>;

static_assert(sizeof(LatticeBox) == 16 && sizeof(Exterior) == 16 && sizeof(LeafEdge) == 16 &&
                  sizeof(Style) == 16 && sizeof(LookTexel) == 16,
              "RGBA32 texels");
static_assert(sizeof(CellStart) == 8 && sizeof(Segment) == 8 && sizeof(QuadLink) == 8 && sizeof(Object) == 8,
              "RG32 texels");

struct QuadTrees {
    LargeArray<LatticeBox> boxes;
    LargeArray<QuadLink> links;
    LargeArray<LeafEdge> edges;
};

enum class GroupKind : uint8_t { fills, strokes, both };

// What any stroke or fill of a group asks for; shaders leave out what none does.
struct GroupNeeds {
    bool translucency = false;
    bool corners = false;  // or caps that are not round, or anything below
    bool patterns = false;
    bool bands = false;
    bool slopes = false;
    bool hatches = false;
};

struct DecalGroup {
    GroupKind kind = GroupKind::strokes;
    OutlineMode cut = OutlineMode::normal;
    GroupNeeds needs;
    uint32_t first_slot = 0;  // of the whole index
    std::vector<Style> styles;
    std::vector<LookTexel> looks;
    float widest = 0.0F;  // half width of a stroke, quanta

    DecalGrid grid;
    LargeArray<CellStart> cells;
    LargeArray<LatticeBox> nodes;
    LargeArray<Object> objects;

    LargeArray<LatticePoint> vertices;
    LargeArray<uint32_t> owners;  // a slot for each vertex; with patterns a slot and the bits of a phase
    LargeArray<Segment> segments;

    LargeArray<LatticePoint> ring_vertices;
    LargeArray<Exterior> exteriors;
    LargeArray<uint32_t> interiors;
    QuadTrees quads;

    uint32_t objects_in(uint32_t cell) const { return cells[cell + 1].object - cells[cell].object; }
    Object object(uint32_t index) const {
        if (kind == GroupKind::both)
            return objects[index];
        return {kind == GroupKind::strokes ? index | STROKE_OBJECT : index, NO_EXTERIOR};
    }
    uint32_t owner(uint32_t vertex) const { return owners[needs.patterns ? 2 * size_t{vertex} : vertex]; }
    float phase(uint32_t vertex) const;
    uint32_t slot_of(Object object) const {
        return object.is_stroke() ? owner(segments[object.segment()].first()) : exteriors[object.place].slot;
    }
};

class PreparedBvh : public Prepared {
public:
    PreparedCounts counts() const override;
    FeatureReference feature(uint32_t id) const override { return slots[id]; }
    std::vector<FeatureReference> query(const SeenPoint& point) const override;
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
    std::vector<FeatureReference> slots;  // of decals: group by group, in each topmost first
    uint64_t features = 0;
    uint64_t segments = 0;
    uint64_t pieces = 0;
    uint64_t longest_walk = 0;
    MemoryCharge charge;
};

// Throws Error(memory) where the index would not fit into the budget or its arrays, Error(unsupported) for
// options that exclude each other, Error(cancelled).
std::unique_ptr<PreparedBvh> build_bvh(const TechniqueInput& input, Progress& progress);

}  // namespace decalgl::bvh

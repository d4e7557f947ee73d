// Prepared static decals in the structures of Zechmeister and Thöny, as flat arrays (bvh_layout.h).
//
// Each data group has a decal grid of its own and is drawn in a pass of its own, from the bottom to the top. Slots keep
// their numbers for as long as the index is changed; their styles say where they stand in draw order.
#pragma once

#include <array>
#include <cstring>
#include <memory>
#include <vector>

#include "core/growing_array.h"
#include "decalgl/core/large_array.h"
#include "decalgl/technique/technique.h"
#include "technique/layer_rules.h"
#include "technique/layer_sources.h"
#include "technique/static_bvh/bvh_layout.h"
#include "technique/static_bvh/decal_grid.h"

namespace decalgl::bvh {

inline float as_float(uint32_t bits) {
    float value = 0.0F;
    std::memcpy(&value, &bits, sizeof(value));
    return value;
}

// What a cell's tree and list of objects begin with, and how many objects there are.
struct CellStart {
    uint32_t node;
    uint32_t object;
    uint32_t count;
    uint32_t unused;
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
    float half_width;  // quanta; of fills 0, of hidden strokes negative
    uint32_t look;     // where it begins
    uint32_t rank;     // in draw order, the topmost 0; no_rank where an edit has taken it away

    bool shows() const { return color[3] != 0; }
};

// A texel of the looks.
using LookTexel = std::array<uint32_t, 4>;

static_assert(sizeof(LatticeBox) == 16 && sizeof(CellStart) == 16 && sizeof(Exterior) == 16 &&
                  sizeof(LeafEdge) == 16 && sizeof(Style) == 16 && sizeof(LookTexel) == 16,
              "RGBA32 texels");
static_assert(sizeof(Segment) == 8 && sizeof(QuadLink) == 8 && sizeof(Object) == 8, "RG32 texels");

template <template <typename> class Array>
struct QuadTreesOf {
    Array<LatticeBox> boxes;
    Array<QuadLink> links;
    Array<LeafEdge> edges;
};

enum class GroupKind : uint8_t { fills, strokes, both };

// What any stroke or fill of a group asks for; shaders leave out what none does.
struct GroupNeeds {
    bool translucency = false;
    bool corners = false;  // or caps that are not round, or anything below
    bool patterns = false;
    bool ground = false;  // some of those patterns are measured along it
    bool bands = false;
    bool slopes = false;
    bool hatches = false;
};

// What builders fill and what is drawn differ in the kind of their arrays alone.
template <template <typename> class Array>
struct GroupOf {
    GroupKind kind = GroupKind::strokes;
    OutlineMode cut = OutlineMode::normal;
    GroupNeeds needs;
    Array<Decal> slots;  // as prepared, topmost first; added ones follow
    Array<Style> styles;
    Array<LookTexel> looks;
    float widest = 0.0F;  // half width of a stroke, quanta

    DecalGrid grid;
    Array<CellStart> cells;
    Array<LatticeBox> nodes;
    Array<Object> objects;

    Array<LatticePoint> vertices;
    Array<uint32_t>
        owners;  // a slot for each vertex; with patterns the bits of a phase, along the ground of a slant too
    Array<Segment> segments;

    Array<LatticePoint> ring_vertices;
    Array<Exterior> exteriors;
    Array<uint32_t> interiors;
    QuadTreesOf<Array> quads;

    Object object(uint32_t index) const {
        if (kind == GroupKind::both)
            return objects[index];
        return {kind == GroupKind::strokes ? index | STROKE_OBJECT : index, NO_EXTERIOR};
    }
    size_t owner_size() const { return needs.ground ? 3 : needs.patterns ? 2 : 1; }
    uint32_t owner(uint32_t vertex) const { return owners[owner_size() * vertex]; }
    // Where a stroke's pattern has come to, in quanta.
    float phase(uint32_t vertex) const {
        return needs.patterns ? as_float(owners[owner_size() * vertex + 1]) : 0.0F;
    }
    // Of lengths along the pattern, on the edge that ends at a vertex.
    float slant(uint32_t vertex) const {
        return needs.ground ? as_float(owners[owner_size() * vertex + 2]) : 1.0F;
    }
    uint32_t slot_of(Object object) const {
        return object.is_stroke() ? owner(segments[object.segment()].first()) : exteriors[object.place].slot;
    }
};

using QuadTrees = QuadTreesOf<LargeArray>;
using GroupBuild = GroupOf<LargeArray>;

// Decals of one layer that are of one kind.
struct DecalClass {
    uint32_t layer;
    DecalRole role;
};

// A group that was built: its arrays are shared by all that is made of it, and edits add to them.
struct DecalGroup : GroupOf<GrownArray> {
    uint32_t first_slot = 0;  // of the whole index
    bool has_shown = true;    // slots of any colour
    bool has_hidden = false;  // slots without, among fills
    uint64_t spent = 0;       // objects that no cell leads to any more
    std::vector<DecalClass> classes;
    std::shared_ptr<const MemoryCharge> charge;

    uint64_t object_count() const {
        return kind == GroupKind::both ? objects.size() : segments.size() + exteriors.size();
    }
};

class PreparedBvh : public Prepared {
public:
    PreparedCounts counts() const override;
    FeatureReference feature(uint32_t id) const override;
    std::vector<FeatureReference> query(const SeenPoint& point) const override;
    // Throws Error(unsupported): the structures are there to be compared with.
    void save(ArchiveWriter& archive, const std::string& prefix) const override;
    bool shows_anything() const override;
    LayerLook look_of(uint32_t layer, size_t features) const override;
    std::shared_ptr<const Prepared> edited(const LayerEdit& edit, const MemoryAccount& memory) const override;
    std::shared_ptr<const Prepared> restyled(Span<const LayerLook> looks,
                                             const MemoryAccount& memory) const override;

    Lattice lattice;
    BvhOptions options;
    std::vector<DecalGroup> groups;  // bottom to top
    uint64_t features = 0;
    uint64_t segments = 0;
    uint64_t pieces = 0;
    uint64_t longest_walk = 0;
    // What changes need.
    std::vector<LayerRules> rules;  // by the layer's place in the scene
    std::shared_ptr<const LayerSources> sources;
    Bounds bounds;
    PositionGrid positions;
    unsigned threads = 0;

    // Numbers the groups' slots, once all groups are there.
    void count_slots();
};

// Throws Error(memory) where the index would not fit into the budget or its arrays, Error(unsupported) for
// options that exclude each other, Error(cancelled).
std::unique_ptr<PreparedBvh> build_bvh(const TechniqueInput& input, Progress& progress);

}  // namespace decalgl::bvh

// Fills as quad-trees in cells (Zechmeister 2020, section 4.2.1).
//
// A feature's first ring is its exterior, all its others interiors: a point that an odd number of them hold
// is inside, which is even-odd whatever rings there are. The box of an exterior in a cell takes in its
// interiors there, so rings need not lie within the first one, and members of a multi-polygon are interiors
// too.
//
//     cell ──▶ tree over exteriors ──▶ exterior: subtree of ring 0, interiors: subtrees of rings 3, 4 and 9
//
// Of each tree a cell refers to the smallest subtree that holds the tree's part of the cell (the culling
// offset), and to none where all leaves there are outside.
#pragma once

#include "technique/static_bvh/cell_objects.h"
#include "technique/static_bvh/lattice_parts.h"
#include "technique/static_bvh/ring_edge.h"

namespace decalgl::bvh {

// Polygons that a group needs the inside of, topmost first, by their places in the input's layers.
struct Polygons {
    std::vector<FeatureReference> features;
    std::vector<uint32_t> slots;  // of their fills, or NO_SLOT
};

class FillBuilder {
public:
    FillBuilder(const TechniqueInput& input, Polygons polygons, GroupBuild& group, MemoryCharge& charge)
        : input_(input), polygons_(std::move(polygons)), group_(group), charge_(charge) {}

    // First: the quad-trees.
    void plant_quad_trees(const Lattice& lattice, const Stage& stage);
    LatticeBox common_box() const;
    // Once the grid is laid: exteriors cell by cell, whose places are returned, one more than there are cells.
    WorkingArray<uint32_t> write_exteriors(const Stage& stage);
    LatticeBox box_of(uint32_t cell, uint32_t exterior) const;
    // The polygon that an exterior belongs to.
    uint32_t polygon_of(uint32_t exterior) const { return polygon_of_[exterior]; }

private:
    // A ring's tree has the ring's number.
    struct Owner {
        uint32_t polygon;
        bool is_exterior;
    };
    // Rows of cells that a tree's box meets.
    struct Strip {
        uint32_t tree;
        CellRange rows;
    };

    LatticeBox list_edges(const LatticePart& part, LargeArray<Edge>& edges) const;
    CellRecords records(const Stage& stage) const;
    std::vector<Strip> list_strips() const;
    template <typename Emit>
    void emit_cells(const Strip& strip, const Emit& emit) const;
    bool holds_part(uint32_t node, const LatticeBox& cell) const;
    uint32_t culled(uint32_t node, const LatticeBox& cell) const;
    void count_exteriors(CellRecords& records, LargeArray<uint32_t>& exterior_starts,
                         LargeArray<uint32_t>& interior_starts);
    void write_cell(CellRecords& records, uint32_t cell, uint32_t next, uint32_t interior);

    const TechniqueInput& input_;
    Polygons polygons_;
    GroupBuild& group_;
    MemoryCharge& charge_;
    std::vector<Owner> owners_;
    std::vector<uint32_t> polygon_of_;
};

}  // namespace decalgl::bvh

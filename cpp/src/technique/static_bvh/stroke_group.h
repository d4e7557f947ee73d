// Strokes as segments in cells (Zechmeister 2020, section 4.2.1; Thöny et al. 2018, section 3.1).
#pragma once

#include "technique/static_bvh/cell_objects.h"
#include "technique/static_bvh/stroke_chains.h"
#include "technique/static_bvh/stroke_outline.h"

namespace decalgl::bvh {

// Along a Hilbert curve through a grid's box.
uint32_t place_on_curve(const Segment& segment, Span<const LatticePoint> vertices, const LatticeBox& box);

class StrokeBuilder {
public:
    // `strokes` in the order of their slots.
    StrokeBuilder(const TechniqueInput& input, std::vector<StrokeSlot> strokes, GroupBuild& group,
                  MemoryCharge& charge);

    // First: vertices and segments, as they come.
    void lay(const Lattice& lattice);
    LatticeBox common_box() const;
    // Once the grid is laid: segments cell by cell, whose places are returned, one more than there are cells.
    WorkingArray<uint32_t> write_segments(const Stage& stage);
    LatticeBox box_of(uint32_t segment) const { return outline_of(group_.segments[segment]).box; }

private:
    StrokeOutline outline_of(Segment segment) const;
    CellRecords records(const Stage& stage) const;
    void sort_along_curve(Span<uint32_t> records) const;

    const TechniqueInput& input_;
    std::vector<StrokeSlot> strokes_;
    std::vector<uint32_t> stroke_of_slot_;
    GroupBuild& group_;
    MemoryCharge& charge_;
    WorkingArray<Segment> laid_;
};

}  // namespace decalgl::bvh

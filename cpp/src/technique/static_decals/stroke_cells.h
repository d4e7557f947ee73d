// Strokes into the cells of a bucket: a segment goes into each cell that its stroke may touch, with the corners at its
// ends.
//
// Ends that come from cutting a segment where 15 bits end lie outside the stroke's reach of the cell, so they
// never show.
#pragma once

#include <cstdint>

#include "decalgl/core/span.h"
#include "technique/static_decals/cell_list_builder.h"
#include "technique/static_decals/style_table.h"

namespace decalgl {

// What is beyond the first and the last point of a stretch of a joined stroke.
struct StrokeEnds {
    bool begins = false;  // the line begins at the first point, else `before` is the point before it
    bool ends = false;    // the line ends at the last point, else `after` is the point after it
    LatticePoint before{};
    LatticePoint after{};
    double periods = 0.0;  // how far along the pattern the first point is
};

class StrokeCells {
public:
    explicit StrokeCells(CellListBuilder& lists) : lists_(&lists) {}

    // Begins a stroke in the bucket that `lists` is at. `open`: the cells where it may show; null: everywhere.
    void begin(uint32_t slot, const DecalShape& shape, const CellMask* open);

    // First all covered cells of a stroke, then its edges, which those do without. Points that follow each
    // other, counted from the bucket's corner; one alone is a dot. `slants`: of edges by the points that they end at, where the
    // stroke follows the ground.
    void mark_covered_cells(Span<const LatticePoint> points);
    void add_edges(Span<const LatticePoint> points, const StrokeEnds& ends, Span<const float> slants);

    // The cells that `add_edges` would go into.
    void mark_touched_cells(Span<const LatticePoint> points, const StrokeEnds& ends, CellMask& touched) const;

private:
    struct Edge {
        LatticePoint a, b;
        double periods;         // at a
        float slant = 1.0F;     // of lengths along the pattern
        bool restarts = false;  // the pattern goes on from another place
        bool begins = false;    // the line begins there
        bool plain = false;     // no corner leads to it
    };

    void add_joined(Span<const LatticePoint> points, const StrokeEnds& ends, Span<const float> slants);
    void add_dot(LatticePoint at, double periods, bool begins, uint32_t cell, int64_t column, int64_t row);
    void add_edge(const Edge& edge, int64_t column, int64_t row);
    double periods_along(const Edge& edge, double quanta) const {
        return quanta * shape_->periods_per_quantum * double{edge.slant};
    }
    // What is told of the pattern where the pen is put down.
    PatternWords pattern_words(double periods, bool begins, float slant) const;
    bool shows_in(uint32_t cell) const { return open_ == nullptr || (*open_)[cell] != 0; }

    // Calls on_edge(edge, reach) and on_dot(point, periods), in order, for what a joined stroke consists of.
    template <typename OnEdge, typename OnDot>
    void for_each_joined(Span<const LatticePoint> points, const StrokeEnds& ends, Span<const float> slants,
                         OnEdge on_edge, OnDot on_dot) const;

    CellListBuilder* lists_;
    SquareRange cells_{};
    uint32_t slot_ = 0;
    const DecalShape* shape_ = nullptr;
    const CellMask* open_ = nullptr;
    int64_t reach_ = 0;  // half width, rounded up
    bool covers_cells_ = false;
};

}  // namespace decalgl

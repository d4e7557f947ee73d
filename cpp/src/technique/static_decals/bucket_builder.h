// One bucket after the other: gathers the edges that references name, chooses how many cells the bucket has,
// and puts rings and lines into them, feature by feature from the topmost.
#pragma once

#include <vector>

#include "technique/static_decals/bucket_references.h"
#include "technique/static_decals/cell_list_builder.h"
#include "technique/static_decals/ring_cells.h"
#include "technique/static_decals/stroke_cells.h"
#include "technique/static_decals/stroke_part.h"

namespace decalgl {

class BucketBuilder {
public:
    explicit BucketBuilder(const OrderedFeatures& features)
        : features_(features), lattice_(*features.grid), rings_(lists_), strokes_(lists_) {}

    // Appends the lists of a bucket to the chunk. `runs` in draw order, sorted into buckets.
    void build(uint32_t bucket, Span<const BucketReferences> runs, CellChunk& chunk);

private:
    // Edges of one feature that follow each other, between points_[first] .. points_[last].
    struct Stretch {
        uint32_t slot;
        size_t first;
        size_t last;
        StrokeEnds ends;  // of joined strokes
        size_t slants;    // of strokes that follow the ground: the place of the first point's
    };

    void gather(uint32_t bucket, Span<const BucketReferences> runs);
    void gather_stretch(const BucketReference& reference, const LatticePoint& corner);
    void gather_joined(const BucketReference& reference, const LatticePoint& corner);
    void drop_near_bends(size_t first, size_t first_slant);
    StrokeEnds ends_of(const StrokePart& part, size_t from, size_t to, const DecalShape& shape,
                       const LatticePoint& corner, const std::vector<double>& lengths) const;
    Span<const Stretch> stretches_of(uint32_t slot, size_t begin) const;
    void prefetch(const BucketReference& reference) const;
    int choose_level() const;
    void add_rings(Span<const Stretch> stretches);
    void add_polygon(uint32_t slot, Span<const Stretch> stretches, bool corner_inside);
    void add_stroke(uint32_t slot, Span<const Stretch> stretches);
    void add_clipped(uint32_t clip, Span<const Stretch> rings, bool corner_inside,
                     Span<const Stretch> strokes);
    Span<const LatticePoint> points_of(const Stretch& stretch) const {
        return {points_.data() + stretch.first, stretch.last - stretch.first + 1};
    }

    // Of strokes that follow the ground, one for each point.
    Span<const float> slants_of(const Stretch& stretch) const {
        return features_.shapes[stretch.slot].follows_ground
                   ? Span<const float>(slants_.data() + stretch.slants, stretch.last - stretch.first + 1)
                   : Span<const float>();
    }

    OrderedFeatures features_;
    Lattice lattice_;
    CellListBuilder lists_;
    RingCells rings_;
    StrokeCells strokes_;
    std::vector<Stretch> stretches_;
    std::vector<uint32_t> corners_;     // slots of the polygons that the bucket's corner is inside of
    std::vector<LatticePoint> points_;  // in quanta from the bucket's corner
    std::vector<float> slants_;         // features.h
    int64_t length_ = 0;                // of all edges in the bucket, |dx| + |dy|, in quanta
    double reach_ = 0.0;                // sum of all segments' half widths, in quanta
};

}  // namespace decalgl

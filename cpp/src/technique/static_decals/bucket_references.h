// Bucket references: which stretches of which features lie in which bucket.
//
//     features in draw order, topmost first, cut into runs of about as many vertices
//
//     run      slot 0 ......... slot 1 ... slot 2 ...................... slot 3
//     bucket A      [edges 3..9]                [edges 40..52]
//     bucket B      [edges 10..17]  [corner]
//
// A run's references are made on their own, and sorted by bucket while they are in the cache. Coordinates stay where they
// are: a reference is 16 bytes for some tens of vertices.
//
// `corner`: the lower left corner of the bucket is inside the polygon. It is known from the crossings of the border
// line below it: up a column of buckets, every crossing turns outside into inside and back.
//
//     row 5   .                 crossings in this column: rows 1 and 4
//     row 4   x  out            corners of rows 2, 3, 4 are inside
//     row 3   # corner
//     row 2   # corner          a bucket within the polygon that no edge passes is
//     row 1   x  in             a reference with `corner` alone
//     row 0   .
#pragma once

#include <cstdint>
#include <vector>

#include "decalgl/core/large_array.h"
#include "decalgl/core/span.h"
#include "decalgl/technique/technique.h"
#include "technique/static_decals/bucket_grid.h"
#include "technique/static_decals/style_table.h"

namespace decalgl {

struct BucketReference {
    uint32_t bucket;
    uint32_t slot;
    uint32_t first;  // edge, named by the vertex it ends at, counted in its layer
    uint32_t count;  // of edges, none for `corner`; or closing_edge
};

// One edge, which comes from the last vertex of its ring; of a line, a dot.
constexpr uint32_t closing_edge = 0xFFFFFFFFU;

// A stretch of the features in draw order. Its first and its last slot may be parts of large features.
struct Run {
    size_t first_slot = 0;
    size_t last_slot = 0;     // inclusive
    size_t first_vertex = 0;  // of the first slot, counted in its layer
    size_t end_vertex = 0;    // of the last slot, one past
    size_t vertices = 0;
    bool part_of_feature = false;  // one slot alone, which other runs hold parts of as well
};

class BucketReferences {
public:
    explicit BucketReferences(const BucketGrid& grid) : grid_(&grid) {}

    void add(const BucketReference& reference) { references_.push_back(reference); }
    // The one that the next edge of the same stretch may continue.
    LargeArray<BucketReference>& references() { return references_; }

    // Brings the references into buckets, keeping their order there. Nothing may be added afterwards.
    void sort_into_buckets();

    Span<const BucketReference> bucket(uint32_t index) const {
        return {references_.data() + bucket_starts_[index],
                bucket_starts_[index + 1] - bucket_starts_[index]};
    }
    size_t bytes() const {
        return references_.size() * sizeof(BucketReference) + bucket_starts_.size() * sizeof(uint32_t);
    }

private:
    const BucketGrid* grid_;
    LargeArray<BucketReference> references_;
    std::vector<uint32_t> bucket_starts_;
};

// Crossings of bucket columns' left borders by the polygon in one slot.
class CornerCrossings {
public:
    // Row -1 is everything below the grid.
    void add(int64_t column, int64_t row) {
        keys_.push_back(static_cast<uint64_t>(column) << 32 | static_cast<uint64_t>(row + 1));
    }
    void append(const CornerCrossings& other) {
        keys_.insert(keys_.end(), other.keys_.begin(), other.keys_.end());
    }
    bool empty() const { return keys_.empty(); }

    // Adds a reference for each bucket whose corner is inside, and forgets the crossings.
    void resolve(const BucketGrid& grid, uint32_t slot, BucketReferences& references);

private:
    std::vector<uint64_t> keys_;
};

// How far along its part each vertex of a layer is, in metres, where that has a pattern along lines.
struct PartLengths {
    std::vector<double> on_map;
    std::vector<double> over_ground;
};

// What is drawn, in draw order: slots name the features, shapes say how they go into cells.
struct OrderedFeatures {
    const TechniqueInput* input;
    const BucketGrid* grid;
    Span<const Decal> slots;
    Span<const DecalShape> shapes;
    Span<const PartLengths> lengths;  // of layers

    const Features& features(size_t slot) const {
        return input->layers[slots[slot].feature.layer - input->first_layer].features;
    }
    const std::vector<double>& lengths_of(size_t slot) const {
        const PartLengths& own = lengths[slots[slot].feature.layer - input->first_layer];
        return shapes[slot].follows_ground ? own.over_ground : own.on_map;
    }
    // Of a feature's vertices, counted in its layer: the first, and one past the last.
    size_t first_vertex(size_t slot) const { return vertex_at(slot, 0); }
    size_t end_vertex(size_t slot) const { return vertex_at(slot, 1); }

private:
    size_t vertex_at(size_t slot, size_t next) const {
        const Features& table = features(slot);
        const int64_t part = table.feature_offsets[slots[slot].feature.feature + next];
        return static_cast<size_t>(table.part_offsets[static_cast<size_t>(part)]);
    }
};

std::vector<Run> cut_into_runs(const OrderedFeatures& features);

// The references of one run, not sorted yet. What a part of a feature crosses goes to `crossings`, to be
// resolved with that of its other parts.
BucketReferences make_references(const OrderedFeatures& features, const Run& run, CornerCrossings& crossings);

}  // namespace decalgl

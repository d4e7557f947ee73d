#include "technique/static_decals/bucket_references.h"

#include <algorithm>
#include <limits>

#include "technique/static_decals/line_reach.h"
#include "technique/static_decals/ring_cuts.h"
#include "technique/static_decals/stroke_part.h"

namespace decalgl {
namespace {

// Few enough runs that a bucket gathers from few places, small enough to share the work between cores.
constexpr size_t wanted_runs = 48;
constexpr size_t smallest_run = 1 << 13;
constexpr size_t largest_run = 1 << 19;
constexpr uint32_t none = std::numeric_limits<uint32_t>::max();

SquareRange all_buckets(const BucketGrid& grid) {
    return {BUCKET_BITS, 0, 0, grid.columns - 1, grid.rows - 1};
}

// Makes the references of one run.
class ReferenceMaker {
public:
    ReferenceMaker(const BucketGrid& grid, BucketReferences& references)
        : lattice_(grid),
          range_(all_buckets(grid)),
          grid_(grid),
          references_(references.references()),
          latest_(grid.bucket_count(), none) {}

    void begin(uint32_t slot) { slot_ = slot; }

    void touch(int64_t column, int64_t row, uint32_t edge, bool closing) {
        const uint32_t bucket = grid_.bucket_index(column, row);
        const uint32_t latest = latest_[bucket];
        if (latest != none && !closing) {
            BucketReference& open = references_[latest];
            if (open.slot == slot_ && open.count != closing_edge && open.first + open.count == edge) {
                ++open.count;
                return;
            }
        }
        latest_[bucket] = static_cast<uint32_t>(references_.size());
        references_.push_back({bucket, slot_, edge, closing ? closing_edge : 1});
    }

    void add_ring_edge(LatticePoint from, LatticePoint to, uint32_t edge, bool closing,
                       CornerCrossings& crossings) {
        const int64_t column = to.x >> BUCKET_BITS, row = to.y >> BUCKET_BITS;
        const bool one_bucket = from.x >> BUCKET_BITS == column && from.y >> BUCKET_BITS == row;
        constexpr int64_t inside = BUCKET_QUANTA - 1;
        if (one_bucket && (from.x & inside) != 0 && (to.x & inside) != 0) {
            if (column >= 0 && column <= range_.last_column && row >= 0 && row <= range_.last_row)
                touch(column, row, edge, closing);
            return;
        }
        RingEdge(from, to).cut(range_, true, [&](int64_t c, int64_t r, LatticePoint a, LatticePoint b) {
            const int64_t left = range_.border(c);
            if ((a.x == left) != (b.x == left))
                crossings.add(c, r);
            if (r >= 0)
                touch(c, r, edge, closing);
        });
    }

    void add_line_segment(LatticePoint from, LatticePoint to, int64_t reach, uint32_t edge, bool dot) {
        for_each_square_near(from, to, reach, range_,
                             [&](int64_t column, int64_t row) { touch(column, row, edge, dot); });
    }

    LatticePoint nearest(const double* xy) const { return lattice_.nearest(xy); }

private:
    Lattice lattice_;
    SquareRange range_;
    const BucketGrid& grid_;
    LargeArray<BucketReference>& references_;
    std::vector<uint32_t> latest_;  // reference of each bucket
    uint32_t slot_ = 0;
};

// Calls on_part(first vertex, end vertex) for each part of a feature.
template <typename OnPart>
void for_each_part(const Features& features, size_t feature, OnPart on_part) {
    const auto first = static_cast<size_t>(features.feature_offsets[feature]);
    const auto last = static_cast<size_t>(features.feature_offsets[feature + 1]);
    for (size_t part = first; part < last; ++part)
        on_part(static_cast<size_t>(features.part_offsets[part]),
                static_cast<size_t>(features.part_offsets[part + 1]));
}

struct VertexRange {
    size_t begin;
    size_t end;
};

void add_ring(const double* vertices, VertexRange ring, VertexRange wanted, ReferenceMaker& maker,
              CornerCrossings& crossings) {
    const size_t begin = std::max(ring.begin, wanted.begin), end = std::min(ring.end, wanted.end);
    if (begin >= end || ring.end - ring.begin < 3)
        return;
    LatticePoint previous = maker.nearest(vertices + 2 * (begin == ring.begin ? ring.end - 1 : begin - 1));
    for (size_t i = begin; i < end; ++i) {
        const LatticePoint next = maker.nearest(vertices + 2 * i);
        if (!(next == previous))
            maker.add_ring_edge(previous, next, static_cast<uint32_t>(i), i == ring.begin, crossings);
        previous = next;
    }
}

// How far the stroke reaches from one of its vertices. Rounding may turn edges of few quanta any way.
double reach_at(const StrokePart& part, size_t vertex, const DecalShape& shape, const ReferenceMaker& maker) {
    const size_t before = part.before(vertex), after = part.after(vertex);
    if (before == part.end || after == part.end)
        return shape.longest_reach();
    const auto point = [&](size_t i) { return maker.nearest(part.vertices + 2 * i); };
    return shape.reach_near(point(before), point(vertex), point(after));
}

// A line of one vertex is a dot.
void add_stroke(const StrokePart& part, VertexRange wanted, const DecalShape& shape, ReferenceMaker& maker) {
    const size_t begin = std::max(part.begin, wanted.begin), end = std::min(part.end, wanted.end);
    if (begin >= end || !part.is_drawn())
        return;
    const bool mitred = shape.is_joined && shape.longest_reach() > double{shape.half_width};
    const auto add_edge = [&](size_t from, size_t to) {
        double reach = shape.half_width;
        if (mitred)
            reach = std::max(reach_at(part, from, shape, maker), reach_at(part, to, shape, maker));
        const double* vertices = part.vertices;
        const bool closing = from >= to;
        maker.add_line_segment(maker.nearest(vertices + 2 * from), maker.nearest(vertices + 2 * to),
                               static_cast<int64_t>(std::ceil(reach)), static_cast<uint32_t>(to), closing);
    };
    for (size_t i = begin; i < end; ++i) {
        if (i > part.begin)
            add_edge(i - 1, i);
        else if (part.is_ring || part.end - part.begin == 1)
            add_edge(part.end - 1, i);
    }
    if (shape.is_joined && end == part.end && part.is_closed())
        add_edge(part.is_ring ? part.end - 1 : part.begin, part.is_ring ? part.begin : part.begin + 1);
}

}  // namespace

void BucketReferences::sort_into_buckets() {
    bucket_starts_.assign(grid_->bucket_count() + size_t{1}, 0);
    for (const BucketReference& reference : references_)
        ++bucket_starts_[reference.bucket + 1];
    for (size_t i = 1; i < bucket_starts_.size(); ++i)
        bucket_starts_[i] += bucket_starts_[i - 1];
    std::vector<uint32_t> cursors(bucket_starts_.begin(), bucket_starts_.end() - 1);
    LargeArray<BucketReference> sorted;
    sorted.resize(references_.size());
    for (const BucketReference& reference : references_)
        sorted[cursors[reference.bucket]++] = reference;
    references_.swap(sorted);
}

void CornerCrossings::resolve(const BucketGrid& grid, uint32_t slot, BucketReferences& references) {
    std::sort(keys_.begin(), keys_.end());
    for (size_t i = 0; i < keys_.size();) {
        const uint64_t column = keys_[i] >> 32;
        const auto row_of = [&](size_t k) { return static_cast<int64_t>(keys_[k] & 0xFFFFFFFFU) - 1; };
        const bool has_end = i + 1 < keys_.size() && keys_[i + 1] >> 32 == column;
        const int64_t last = has_end ? row_of(i + 1) : grid.rows - 1;
        for (int64_t row = row_of(i) + 1; row <= last; ++row)
            references.add({grid.bucket_index(static_cast<int64_t>(column), row), slot, 0, 0});
        i += has_end ? 2 : 1;
    }
    keys_.clear();
}

std::vector<Run> cut_into_runs(const OrderedFeatures& features) {
    size_t vertices = 0;
    for (const Layer& layer : features.input->layers)
        vertices += layer.features.vertex_count();
    const size_t target = std::clamp(vertices / wanted_runs, smallest_run, largest_run);
    std::vector<Run> runs;
    Run run;
    const auto close = [&] {
        if (run.vertices > 0)
            runs.push_back(run);
        run = Run{};
    };
    for (size_t slot = 0; slot < features.slots.size(); ++slot) {
        const size_t first = features.first_vertex(slot), end = features.end_vertex(slot);
        if (end - first > 2 * target) {
            close();
            for (size_t part = first; part < end; part += target) {
                const size_t part_end = std::min(part + target, end);
                runs.push_back({slot, slot, part, part_end, part_end - part, true});
            }
            continue;
        }
        if (run.vertices == 0) {
            run.first_slot = slot;
            run.first_vertex = first;
        }
        run.last_slot = slot;
        run.end_vertex = end;
        run.vertices += end - first;
        if (run.vertices >= target)
            close();
    }
    close();
    return runs;
}

BucketReferences make_references(const OrderedFeatures& features, const Run& run,
                                 CornerCrossings& crossings) {
    BucketReferences references(*features.grid);
    references.references().reserve(run.vertices / 4 + 64);
    ReferenceMaker maker(*features.grid, references);
    for (size_t slot = run.first_slot; slot <= run.last_slot; ++slot) {
        const Features& table = features.features(slot);
        const size_t feature = features.slots[slot].feature.feature;
        const double* vertices = table.coordinates.data();
        const VertexRange wanted{slot == run.first_slot ? run.first_vertex : features.first_vertex(slot),
                                 slot == run.last_slot ? run.end_vertex : features.end_vertex(slot)};
        maker.begin(static_cast<uint32_t>(slot));
        const DecalShape& shape = features.shapes[slot];
        const bool rings = table.kind == FeatureKind::polygons;
        for_each_part(table, feature, [&](size_t begin, size_t end) {
            if (shape.is_stroke)
                add_stroke({vertices, begin, end, rings}, wanted, shape, maker);
            else
                add_ring(vertices, {begin, end}, wanted, maker, crossings);
        });
        if (!run.part_of_feature)
            crossings.resolve(*features.grid, static_cast<uint32_t>(slot), references);
    }
    return references;
}

}  // namespace decalgl

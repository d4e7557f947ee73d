#include "technique/static_decals/bucket_builder.h"

#include <algorithm>
#include <cmath>

namespace decalgl {
namespace {

// A bucket gets the finest cells at which an edge costs this many words, its share of the entries included, and
// there are this many edges for each cell.
constexpr double words_per_edge = 4.5;
constexpr double edges_per_cell = 0.7;

constexpr size_t lookahead = 3;  // references

// How far an edge goes inside the bucket, |dx| + |dy|.
int64_t length_inside(LatticePoint a, LatticePoint b) {
    const auto clamped = [](int64_t value) { return std::clamp<int64_t>(value, 0, BUCKET_QUANTA); };
    return std::abs(clamped(b.x) - clamped(a.x)) + std::abs(clamped(b.y) - clamped(a.y));
}

}  // namespace

void BucketBuilder::gather_stretch(const BucketReference& reference, const LatticePoint& corner) {
    const Features& table = features_.features(reference.slot);
    const double* vertices = table.coordinates.data();
    const auto add_point = [&](size_t vertex) {
        const LatticePoint point = lattice_.nearest(vertices + 2 * vertex);
        points_.push_back({point.x - corner.x, point.y - corner.y});
    };
    const size_t first = points_.size();
    const bool closes = reference.count == closing_edge;
    if (!closes) {
        add_point(reference.first - size_t{1});
    } else if (table.kind == FeatureKind::polygons) {
        const int64_t* next =
            std::upper_bound(table.part_offsets.begin(), table.part_offsets.end(), int64_t{reference.first});
        add_point(static_cast<size_t>(*next - 1));
    }
    const size_t edges = closes ? 1 : reference.count;
    for (size_t i = 0; i < edges; ++i)
        add_point(reference.first + i);
    stretches_.push_back({reference.slot, first, points_.size() - 1});
    for (size_t i = first + 1; i < points_.size(); ++i)
        length_ += length_inside(points_[i - 1], points_[i]);
    reach_ += static_cast<double>(edges) * static_cast<double>(features_.half_widths[reference.slot]);
}

void BucketBuilder::gather(uint32_t bucket, Span<const BucketReferences> runs) {
    stretches_.clear();
    corners_.clear();
    points_.clear();
    length_ = 0;
    reach_ = 0.0;
    const auto columns = static_cast<uint32_t>(features_.grid->columns);
    const LatticePoint corner{int64_t{bucket % columns} << BUCKET_BITS,
                              int64_t{bucket / columns} << BUCKET_BITS};
    for (const BucketReferences& run : runs) {
        const Span<const BucketReference> references = run.bucket(bucket);
        for (size_t i = 0; i < references.size(); ++i) {
            if (i + lookahead < references.size())
                prefetch(references[i + lookahead]);
            if (references[i].count == 0)
                corners_.push_back(references[i].slot);
            else
                gather_stretch(references[i], corner);
        }
    }
}

// Stretches lie far apart in memory: what is needed soon is asked for now.
void BucketBuilder::prefetch(const BucketReference& reference) const {
    __builtin_prefetch(features_.features(reference.slot).coordinates.data() + 2 * size_t{reference.first});
}

int BucketBuilder::choose_level() const {
    if (points_.empty())
        return 0;
    const auto edges = static_cast<double>(points_.size());
    const auto corners = static_cast<double>(corners_.size());
    for (int level = FINEST_LEVEL; level > COARSEST_LEVEL; --level) {
        const double cell = cell_quanta(level);
        const double cells = std::ldexp(1.0, 2 * level);
        const double across = 1.0 + 2.0 * reach_ / edges / cell;
        const double pieces = edges * across * across + static_cast<double>(length_) * across / cell;
        const double words = 1.6 * pieces + cells * (0.3 + 0.5 * corners);
        if (words <= words_per_edge * edges && cells * edges_per_cell <= edges)
            return level;
    }
    return COARSEST_LEVEL;
}

void BucketBuilder::build(uint32_t bucket, Span<const BucketReferences> runs, CellChunk& chunk) {
    gather(bucket, runs);
    lists_.begin(choose_level());
    size_t corner = 0;
    for (size_t begin = 0; begin < stretches_.size() || corner < corners_.size();) {
        uint32_t slot = begin < stretches_.size() ? stretches_[begin].slot : corners_[corner];
        if (corner < corners_.size())
            slot = std::min(slot, corners_[corner]);
        size_t end = begin;
        while (end < stretches_.size() && stretches_[end].slot == slot)
            ++end;
        const Span<const Stretch> stretches(stretches_.data() + begin, end - begin);
        const bool corner_inside = corner < corners_.size() && corners_[corner] == slot;
        corner += corner_inside ? 1 : 0;
        begin = end;
        if (features_.features(slot).kind == FeatureKind::polygons)
            add_polygon(slot, stretches, corner_inside);
        else
            add_line(slot, stretches);
    }
    lists_.finish(chunk);
}

void BucketBuilder::add_polygon(uint32_t slot, Span<const Stretch> stretches, bool corner_inside) {
    rings_.begin(slot);
    for (const Stretch& stretch : stretches)
        for (size_t i = stretch.first; i < stretch.last; ++i)
            rings_.add_edge(points_[i], points_[i + 1]);
    rings_.finish(corner_inside);
}

void BucketBuilder::add_line(uint32_t slot, Span<const Stretch> stretches) {
    lines_.begin(slot, features_.half_widths[slot]);
    if (features_.is_fixed(slot))
        for (const Stretch& stretch : stretches)
            lines_.mark_covered_cells(points_of(stretch));
    for (const Stretch& stretch : stretches)
        lines_.add_edges(points_of(stretch));
}

}  // namespace decalgl

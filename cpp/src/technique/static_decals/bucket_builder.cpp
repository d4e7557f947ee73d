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

constexpr double shortest_to_bend = 64.0;  // quanta from a place where the ground bends to the next vertex

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
    stretches_.push_back({reference.slot, first, points_.size() - 1, {}, 0});
    for (size_t i = first + 1; i < points_.size(); ++i)
        length_ += length_inside(points_[i - 1], points_[i]);
    reach_ += static_cast<double>(edges) * static_cast<double>(features_.shapes[reference.slot].half_width);
}

// The part of a feature that a vertex lies in.
StrokePart part_with(const Features& table, size_t vertex) {
    const int64_t* next =
        std::upper_bound(table.part_offsets.begin(), table.part_offsets.end(), static_cast<int64_t>(vertex));
    return {table.coordinates.data(), static_cast<size_t>(next[-1]), static_cast<size_t>(next[0]),
            table.kind == FeatureKind::polygons};
}

// What is beyond the first and the last point of a stretch from one vertex to another.
StrokeEnds BucketBuilder::ends_of(const StrokePart& part, size_t from, size_t to, const DecalShape& shape,
                                  const LatticePoint& corner, const std::vector<double>& lengths) const {
    StrokeEnds ends;
    const auto point = [&](size_t vertex) {
        const LatticePoint at = lattice_.nearest(part.vertices + 2 * vertex);
        return LatticePoint{at.x - corner.x, at.y - corner.y};
    };
    const size_t before = part.before(from), after = part.after(to);
    ends.begins = before == part.end;
    ends.ends = after == part.end;
    if (!ends.begins)
        ends.before = point(before);
    if (!ends.ends)
        ends.after = point(after);
    if (shape.periods_per_quantum > 0.0)
        ends.periods =
            shape.first_period + lengths[from] / features_.grid->quantum * shape.periods_per_quantum;
    return ends;
}

// As above for a joined stroke, whose points all differ from the one before.
void BucketBuilder::gather_joined(const BucketReference& reference, const LatticePoint& corner) {
    const DecalShape& shape = features_.shapes[reference.slot];
    const Features& table = features_.features(reference.slot);
    const StrokePart part = part_with(table, reference.first);
    const bool closes = reference.count == closing_edge;
    const size_t from = closes ? part.end - 1 : reference.first - size_t{1};
    const size_t to = closes ? reference.first : reference.first + reference.count - size_t{1};
    const size_t first = points_.size(), first_slant = slants_.size();
    const auto add_point = [&](size_t vertex) {
        const float slant = table.slants.empty() ? 1.0F : table.slants[vertex];
        if (slant < 0.0F && !shape.follows_ground && vertex != from && vertex != to)
            return;
        const LatticePoint at = lattice_.nearest(part.vertices + 2 * vertex);
        const LatticePoint point{at.x - corner.x, at.y - corner.y};
        if (points_.size() != first && points_.back() == point) {
            // The line's own vertex counts.
            if (shape.follows_ground && slant > 0.0F)
                slants_.back() = std::abs(slants_.back());
            return;
        }
        points_.push_back(point);
        if (shape.follows_ground)
            slants_.push_back(slant);
    };
    add_point(from);
    for (size_t vertex = closes ? to : from + 1; vertex <= to; ++vertex)
        add_point(vertex);
    if (shape.follows_ground)
        drop_near_bends(first, first_slant);
    stretches_.push_back({reference.slot, first, points_.size() - 1,
                          ends_of(part, from, to, shape, corner, features_.lengths_of(reference.slot)),
                          first_slant});
    for (size_t i = first + 1; i < points_.size(); ++i)
        length_ += length_inside(points_[i - 1], points_[i]);
    reach_ += static_cast<double>(points_.size() - first) * static_cast<double>(shape.half_width);
}

// Edges that are very short would turn as their ends are rounded, and the corners beside them too.
void BucketBuilder::drop_near_bends(size_t first, size_t first_slant) {
    const auto slant = [&](size_t point) -> float& { return slants_[first_slant + point - first]; };
    size_t kept = first;
    for (size_t i = first + 1; i < points_.size(); ++i) {
        if (slant(i) < 0.0F && i + 1 < points_.size()) {
            const double before = length_of(points_[kept], points_[i]);
            const double after = length_of(points_[i], points_[i + 1]);
            if (std::min(before, after) < shortest_to_bend) {
                const double mean =
                    (before * std::abs(double{slant(i)}) + after * std::abs(double{slant(i + 1)})) /
                    (before + after);
                slant(i + 1) = std::copysign(static_cast<float>(mean), slant(i + 1));
                continue;
            }
        }
        ++kept;
        points_[kept] = points_[i];
        slant(kept) = slant(i);
    }
    points_.resize(kept + 1);
    slants_.resize(first_slant + kept + 1 - first);
}

void BucketBuilder::gather(uint32_t bucket, Span<const BucketReferences> runs) {
    stretches_.clear();
    corners_.clear();
    points_.clear();
    slants_.clear();
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
            else if (features_.shapes[references[i].slot].is_joined)
                gather_joined(references[i], corner);
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
        const Span<const Stretch> stretches = stretches_of(slot, begin);
        begin += stretches.size();
        const bool corner_inside = corner < corners_.size() && corners_[corner] == slot;
        corner += corner_inside ? 1 : 0;
        if (features_.shapes[slot].is_clip) {
            const Span<const Stretch> strokes = stretches_of(slot + 1, begin);
            begin += strokes.size();
            add_clipped(slot, stretches, corner_inside, strokes);
        } else if (features_.shapes[slot].is_clipped) {
            add_clipped(slot - 1, {}, false, stretches);
        } else if (features_.shapes[slot].is_stroke) {
            add_stroke(slot, stretches);
        } else {
            add_polygon(slot, stretches, corner_inside);
        }
    }
    lists_.finish(chunk);
}

// From `begin` on, those of a slot; they follow each other.
Span<const BucketBuilder::Stretch> BucketBuilder::stretches_of(uint32_t slot, size_t begin) const {
    size_t end = begin;
    while (end < stretches_.size() && stretches_[end].slot == slot)
        ++end;
    return {stretches_.data() + begin, end - begin};
}

void BucketBuilder::add_rings(Span<const Stretch> stretches) {
    for (const Stretch& stretch : stretches)
        for (size_t i = stretch.first; i < stretch.last; ++i)
            rings_.add_edge(points_[i], points_[i + 1]);
}

void BucketBuilder::add_polygon(uint32_t slot, Span<const Stretch> stretches, bool corner_inside) {
    rings_.begin(slot);
    add_rings(stretches);
    rings_.finish(corner_inside);
}

void BucketBuilder::add_stroke(uint32_t slot, Span<const Stretch> stretches) {
    strokes_.begin(slot, features_.shapes[slot], nullptr);
    for (const Stretch& stretch : stretches)
        strokes_.mark_covered_cells(points_of(stretch));
    for (const Stretch& stretch : stretches)
        strokes_.add_edges(points_of(stretch), stretch.ends, slants_of(stretch));
}

// The rings are needed only where the stroke is, and the stroke only where they do not cut it off.
void BucketBuilder::add_clipped(uint32_t clip, Span<const Stretch> rings, bool corner_inside,
                                Span<const Stretch> strokes) {
    const DecalShape& stroke = features_.shapes[clip + 1];
    CellMask touched(lists_.cell_count(), 0);
    strokes_.begin(clip + 1, stroke, nullptr);
    for (const Stretch& stretch : strokes)
        strokes_.mark_touched_cells(points_of(stretch), stretch.ends, touched);
    rings_.begin_clip(clip, touched);
    add_rings(rings);
    const CellMask open = rings_.finish_clip(corner_inside, features_.shapes[clip].is_offset);
    strokes_.begin(clip + 1, stroke, &open);
    for (const Stretch& stretch : strokes)
        strokes_.mark_covered_cells(points_of(stretch));
    for (const Stretch& stretch : strokes)
        strokes_.add_edges(points_of(stretch), stretch.ends, slants_of(stretch));
}

}  // namespace decalgl

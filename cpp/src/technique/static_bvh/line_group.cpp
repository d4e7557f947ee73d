#include "technique/static_bvh/line_group.h"

#include "technique/static_bvh/hilbert.h"

namespace decalgl::bvh {
namespace {

constexpr size_t vertices_at_once = 1 << 14;

// Vertices are fewer than this (storage.h). A segment goes by its first one; the second is the next, or the
// same one for a line of a single vertex.
constexpr uint32_t dot_flag = 1U << 31;

Segment segment_of(uint32_t record, const LargeArray<LatticePoint>& vertices) {
    const uint32_t a = record & ~dot_flag;
    const uint32_t b = (record & dot_flag) != 0 ? a : a + 1;
    // From the left or lower end, so that lines over each other are at the same distance to the last digit.
    const LatticePoint p = vertices[a], q = vertices[b];
    return q.x < p.x || (q.x == p.x && q.y < p.y) ? Segment{b, a} : Segment{a, b};
}

// Calls on_segment(part, record) for the segments that begin at the vertices from `begin` to `end`.
template <typename OnSegment>
void for_each_segment(const std::vector<LatticePart>& parts, size_t begin, size_t end, OnSegment on_segment) {
    for (size_t at = part_of_vertex(parts, begin); at < parts.size() && parts[at].first_vertex < end; ++at) {
        const LatticePart& part = parts[at];
        const uint32_t step = part.is_pairs ? 2 : 1;
        const uint32_t last = part.first_vertex + part.vertex_count;
        auto vertex = std::max(static_cast<uint32_t>(begin), part.first_vertex);
        vertex += (vertex - part.first_vertex) % step;
        for (; vertex < std::min<size_t>(end, last); vertex += step) {
            if (vertex + 1 < last)
                on_segment(part, vertex);
            else if (part.vertex_count == 1)
                on_segment(part, vertex | dot_flag);
        }
    }
}

class LineBuilder {
public:
    LineBuilder(const TechniqueInput& input, const std::vector<LatticePart>& parts, DecalGroup& group,
                MemoryCharge& charge)
        : input_(input), parts_(parts), group_(group), charge_(charge) {}

    void set_owners() {
        grow(group_.owners, group_.vertices.size(), "vertices", charge_);
        parallel_for(parts_.size(), 256, input_.threads, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i)
                std::fill_n(group_.owners.begin() + parts_[i].first_vertex, parts_[i].vertex_count,
                            parts_[i].slot);
        });
    }

    LatticeBox common_box() const {
        std::vector<LatticeBox> boxes(block_count(group_.vertices.size(), vertices_at_once), empty_box);
        for_segments([&](size_t block, const LatticePart& part, uint32_t record) {
            boxes[block] = merged(boxes[block], box_of(segment_of(record, group_.vertices), part.slot));
        });
        LatticeBox all = empty_box;
        for (const LatticeBox& box : boxes)
            all = merged(all, box);
        return all;
    }

    CellRecords records(const Stage& stage) const {
        return collect_records(group_.vertices.size(), vertices_at_once, group_.grid.cell_count(), input_,
                               stage, [&](size_t begin, size_t end, auto emit) {
                                   for_each_segment(parts_, begin, end,
                                                    [&](const LatticePart& part, uint32_t record) {
                                                        emit_cells(part.slot, record, emit);
                                                    });
                               });
    }

    void write_segments(CellRecords records, const Stage& stage) {
        grow(group_.cells, uint64_t{group_.grid.cell_count()} + 1, "cells", charge_);
        grow(group_.segments, records.objects.values.size(), "segments in cells", charge_);
        for (size_t cell = 0; cell < group_.cells.size(); ++cell)
            group_.cells[cell].object = records.starts.values[cell];
        parallel_for(
            group_.grid.cell_count(), cells_at_once, input_.threads,
            [&](size_t begin, size_t end) {
                for (size_t cell = begin; cell < end; ++cell)
                    write_cell(records.of(static_cast<uint32_t>(cell)), group_.cells[cell].object);
            },
            stage.part(0.0, 0.4).report());
        plant_trees(group_, charge_, input_.threads, stage.part(0.4, 1.0), [&](uint32_t, uint32_t object) {
            const Segment segment = group_.segments[object];
            return box_of(segment, group_.owners[segment.a]);
        });
    }

private:
    LatticeBox box_of(Segment segment, uint32_t slot) const {
        return stroke_box(group_.vertices[segment.a], group_.vertices[segment.b],
                          double{group_.styles[slot].half_width});
    }

    template <typename OnSegment>
    void for_segments(OnSegment on_segment) const {
        parallel_for(group_.vertices.size(), vertices_at_once, input_.threads, [&](size_t begin, size_t end) {
            for_each_segment(parts_, begin, end, [&](const LatticePart& part, uint32_t record) {
                on_segment(begin / vertices_at_once, part, record);
            });
        });
    }

    template <typename Emit>
    void emit_cells(uint32_t slot, uint32_t record, const Emit& emit) const {
        const Segment segment = segment_of(record, group_.vertices);
        const Quadrilateral outline = stroke_outline(group_.vertices[segment.a], group_.vertices[segment.b],
                                                     double{group_.styles[slot].half_width});
        group_.grid.for_each_cell(outline, box_of(segment, slot), [&](uint32_t cell) { emit(cell, record); });
    }

    // The records come in draw order.
    void write_cell(Span<uint32_t> records, uint32_t first) {
        if (input_.bvh.segment_order == SegmentOrder::hilbert)
            sort_along_curve(records);
        for (size_t i = 0; i < records.size(); ++i)
            group_.segments[first + i] = segment_of(records[i], group_.vertices);
    }

    void sort_along_curve(Span<uint32_t> records) const {
        std::vector<std::pair<uint32_t, uint32_t>> places(records.size());
        for (size_t i = 0; i < records.size(); ++i)
            places[i] = {place_on_curve(records[i]), records[i]};
        std::stable_sort(places.begin(), places.end(),
                         [](const auto& a, const auto& b) { return a.first < b.first; });
        for (size_t i = 0; i < records.size(); ++i)
            records[i] = places[i].second;
    }

    uint32_t place_on_curve(uint32_t record) const {
        const Segment segment = segment_of(record, group_.vertices);
        const LatticePoint a = group_.vertices[segment.a], b = group_.vertices[segment.b];
        const LatticeBox& box = group_.grid.box;
        const auto middle = [](int64_t p, int64_t q, int64_t low, int64_t high) {
            return static_cast<uint32_t>((std::clamp((p + q) / 2, low, high) - low) * 0xFFFF /
                                         std::max<int64_t>(high - low, 1));
        };
        return hilbert_place(middle(a.x, b.x, box.min_x, box.max_x), middle(a.y, b.y, box.min_y, box.max_y));
    }

    const TechniqueInput& input_;
    const std::vector<LatticePart>& parts_;
    DecalGroup& group_;
    MemoryCharge& charge_;
};

}  // namespace

void build_lines(const TechniqueInput& input, LatticeParts parts, const Lattice& lattice, DecalGroup& group,
                 MemoryCharge& charge, const Stage& stage) {
    group.vertices = std::move(parts.vertices);
    LineBuilder builder(input, parts.parts, group, charge);
    builder.set_owners();
    group.grid = DecalGrid::over(common(builder.common_box(), lattice.terrain), input.bvh.cells);
    builder.write_segments(builder.records(stage.part(0.0, 0.6)), stage.part(0.6, 1.0));
}

}  // namespace decalgl::bvh

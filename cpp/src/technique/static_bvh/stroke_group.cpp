#include "technique/static_bvh/stroke_group.h"

#include "technique/static_bvh/hilbert.h"

namespace decalgl::bvh {
namespace {

constexpr size_t segments_at_once = 1 << 14;

}  // namespace

StrokeBuilder::StrokeBuilder(const TechniqueInput& input, std::vector<StrokeSlot> strokes, GroupBuild& group,
                             MemoryCharge& charge)
    : input_(input),
      strokes_(std::move(strokes)),
      group_(group),
      charge_(charge),
      laid_(input.memory, 0, "segments") {
    stroke_of_slot_.resize(group.styles.size());
    for (uint32_t stroke = 0; stroke < strokes_.size(); ++stroke)
        stroke_of_slot_[strokes_[stroke].slot] = stroke;
}

void StrokeBuilder::lay(const Lattice& lattice) {
    lay_chains(input_, strokes_, lattice, group_, charge_, laid_);
}

StrokeOutline StrokeBuilder::outline_of(Segment segment) const {
    const uint32_t a = segment.first(), b = segment.second();
    const StrokeSlot& stroke = strokes_[stroke_of_slot_[group_.owner(a)]];
    const auto& at = group_.vertices;
    if (!group_.needs.corners)
        return round_outline(at[a], at[b], stroke.half_width);
    const bool forward = a < b;
    return styled_outline({at[a], at[forward ? a - 1 : a + 1], segment.a != a},
                          {at[b], at[forward ? b + 1 : b - 1], segment.b != b}, stroke.decal.style(),
                          stroke.half_width);
}

LatticeBox StrokeBuilder::common_box() const {
    const size_t count = laid_.values.size();
    std::vector<LatticeBox> boxes(block_count(count, segments_at_once));
    parallel_for(count, segments_at_once, input_.threads, [&](size_t begin, size_t end) {
        LatticeBox& box = boxes[begin / segments_at_once];
        for (size_t i = begin; i < end; ++i)
            box.add(outline_of(laid_.values[i]).box);
    });
    LatticeBox all;
    for (const LatticeBox& box : boxes)
        all.add(box);
    return all;
}

CellRecords StrokeBuilder::records(const Stage& stage) const {
    return collect_records(laid_.values.size(), segments_at_once, group_.grid.cell_count(), input_, stage,
                           [&](size_t begin, size_t end, auto emit) {
                               for (size_t i = begin; i < end; ++i) {
                                   const StrokeOutline outline = outline_of(laid_.values[i]);
                                   group_.grid.for_each_cell(
                                       outline.corners, outline.box,
                                       [&](uint32_t cell) { emit(cell, static_cast<uint32_t>(i)); });
                               }
                           });
}

WorkingArray<uint32_t> StrokeBuilder::write_segments(const Stage& stage) {
    CellRecords records = this->records(stage.part(0.0, 0.8));
    grow(group_.segments, records.objects.values.size(), "segments in cells", charge_);
    // The records come in draw order.
    const bool curve = input_.bvh.segment_order == SegmentOrder::hilbert && group_.kind == GroupKind::strokes;
    parallel_for(
        group_.grid.cell_count(), cells_at_once, input_.threads,
        [&](size_t begin, size_t end) {
            for (size_t cell = begin; cell < end; ++cell) {
                const Span<uint32_t> own = records.of(static_cast<uint32_t>(cell));
                if (curve)
                    sort_along_curve(own);
                for (size_t i = 0; i < own.size(); ++i)
                    group_.segments[records.starts.values[cell] + i] = laid_.values[own[i]];
            }
        },
        stage.part(0.8, 1.0).report());
    return std::move(records.starts);
}

void StrokeBuilder::sort_along_curve(Span<uint32_t> records) const {
    std::vector<std::pair<uint32_t, uint32_t>> places(records.size());
    for (size_t i = 0; i < records.size(); ++i)
        places[i] = {place_on_curve(laid_.values[records[i]], group_.vertices, group_.grid.box), records[i]};
    std::stable_sort(places.begin(), places.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (size_t i = 0; i < records.size(); ++i)
        records[i] = places[i].second;
}

uint32_t place_on_curve(const Segment& segment, Span<const LatticePoint> vertices, const LatticeBox& box) {
    const LatticePoint a = vertices[segment.first()], b = vertices[segment.second()];
    const auto middle = [](int64_t p, int64_t q, int64_t low, int64_t high) {
        return static_cast<uint32_t>((std::clamp((p + q) / 2, low, high) - low) * 0xFFFF /
                                     std::max<int64_t>(high - low, 1));
    };
    return hilbert_place(middle(a.x, b.x, box.min_x, box.max_x), middle(a.y, b.y, box.min_y, box.max_y));
}

}  // namespace decalgl::bvh

// Prepared LOOPS in an archive: the arrays as they are, and their scalars as records.
//
//     record, detail         scalars                     points, arc_..., fill_..., stroke_...   arcs and their users
//     decals, styles, ...    slots                       activations, steps                      what is active where
//     bvh_...                the paper's index, where it was chosen
//
// Opening reads every array and refuses what would lead a view, a query or a shader out of them.
#include <cmath>

#include "core/archive.h"
#include "technique/draw_order.h"
#include "technique/loops/prepared_loops.h"
#include "technique/loops/tree_check.h"

namespace decalgl::loops {
namespace {

// Without padding, since their bytes go into the file.
struct IndexRecord {
    Lattice lattice;
    GroundRange heights;
    uint32_t first_layer;
    uint64_t segments;
    uint64_t needs;
    uint32_t has_bvh;
    uint32_t has_eye;
    uint32_t shows;
    uint32_t unused;
};
static_assert(sizeof(IndexRecord) == 128, "saved as it is");

struct DetailRecord {
    double uniform;
    double screen;
    double lens;
    std::array<double, 2> lens_centre;
    double lens_radius;
    double heat_top;
    DetailEye eye;
};
static_assert(sizeof(DetailRecord) == 128, "saved as it is");

struct BvhRecord {
    TreeCounts counts;
    uint64_t items;
    uint32_t primitives;
    uint32_t most_lists;
};
static_assert(sizeof(BvhRecord) == 40, "saved as it is");

LoopsDetail detail_of(const DetailRecord& record, const IndexRecord& index,
                      const SharedArray<DetailStep>& steps) {
    LoopsDetail detail;
    detail.uniform = record.uniform;
    detail.screen = record.screen;
    detail.lens = record.lens;
    detail.lens_centre = record.lens_centre;
    detail.lens_radius = record.lens_radius;
    detail.heat_top = record.heat_top;
    detail.eye = record.eye;
    detail.has_eye = index.has_eye != 0;
    detail.shows = static_cast<LoopsDetail::Shows>(index.shows);
    detail.steps.assign(steps.begin(), steps.end());
    return detail;
}

bool is_lattice(const Lattice& lattice, const GroundRange& heights) {
    int exponent = 0;
    const LatticeBox& box = lattice.terrain;
    return std::isfinite(heights.lowest) && std::isfinite(heights.highest) && std::isfinite(lattice.left) &&
           std::isfinite(lattice.bottom) && std::isfinite(lattice.quantum) &&
           std::frexp(lattice.quantum, &exponent) == 0.5 && std::abs(exponent) < 64 && box.min_x >= 0 &&
           box.min_y >= 0 && box.min_x <= box.max_x && box.min_y <= box.max_y &&
           box.max_x <= (1 << lattice_bits) && box.max_y <= (1 << lattice_bits);
}

// Whether lists follow each other and hold all that there is.
template <typename Offset>
bool are_offsets(const SharedArray<Offset>& offsets, size_t values) {
    return !offsets.empty() && offsets[0] == 0 && std::is_sorted(offsets.begin(), offsets.end()) &&
           offsets[offsets.size() - 1] == values;
}

bool are_arcs(const KeptArcs& arcs) {
    const auto is_on_lattice = [](LatticePoint p) {
        return 0 <= p.x && p.x <= (1 << lattice_bits) && 0 <= p.y && p.y <= (1 << lattice_bits);
    };
    const auto is_arc = [&](uint32_t arc) { return arc < arcs.count(); };
    if (!are_offsets(arcs.offsets, arcs.points.size()) || arcs.offsets.size() != arcs.count() + 1 ||
        arcs.fill_offsets.size() != arcs.stroke_offsets.size() ||
        !are_offsets(arcs.fill_offsets, arcs.fill_arcs.size()) ||
        !are_offsets(arcs.stroke_offsets, arcs.stroke_arcs.size()))
        return false;
    for (size_t arc = 0; arc < arcs.count(); ++arc)
        if (arcs.size_of(arc) < 2 || arcs.kinds[arc] > ArcKind::frame)
            return false;
    return std::all_of(arcs.points.begin(), arcs.points.end(), is_on_lattice) &&
           std::all_of(arcs.fill_arcs.begin(), arcs.fill_arcs.end(), is_arc) &&
           std::all_of(arcs.stroke_arcs.begin(), arcs.stroke_arcs.end(), is_arc);
}

// Steps stay in their arc, and end with it.
bool are_steps(const KeptArcs& arcs, const SharedArray<Step>& steps) {
    if (steps.size() != arcs.points.size())
        return false;
    for (size_t arc = 0; arc < arcs.count(); ++arc) {
        const uint32_t last = arcs.end(arc) - 2;
        for (uint32_t i = arcs.begin(arc); i < last && arcs.kinds[arc] != ArcKind::frame; ++i)
            if (steps[i].point < arcs.begin(arc) || steps[i].point >= arcs.end(arc) || steps[i].size == 0 ||
                steps[i].size > last - i)
                return false;
    }
    return true;
}

bool are_slots(const Slots& slots, const LoopsIndex& index) {
    const size_t count = slots.decals.size(), features = index.arcs.fill_offsets.size() - 1;
    if (slots.features.size() != count || slots.styles.size() != count || !permutes(slots.upwards, count) ||
        slots.reaches.size() != index.arcs.count())
        return false;
    for (size_t slot = 0; slot < count; ++slot) {
        const Decal& decal = slots.decals[slot];
        const Style& style = slots.styles[slot];
        if (decal.role > DecalRole::casing || decal.feature.layer < index.first_layer ||
            decal.feature.layer - index.first_layer >= index.outlines.size() ||
            slots.features[slot] >= features || !(style.half_width >= 0.0F) ||
            style.is_fill() == decal.is_stroke())
            return false;
    }
    return true;
}

Bvh open_bvh(const ArchiveReader& archive, const std::string& prefix, const LoopsIndex& index, size_t slots) {
    const auto record = archive.value<BvhRecord>(prefix + "bvh_record");
    Bvh bvh;
    bvh.counts = record.counts;
    bvh.items = record.items;
    bvh.primitives = static_cast<LinePrimitives>(record.primitives);
    bvh.most_lists = record.most_lists;
    bvh.bases = archive.array<Base>(prefix + "bvh_bases");
    bvh.words = archive.array<uint32_t>(prefix + "bvh_words");
    if (record.primitives > static_cast<uint32_t>(LinePrimitives::segments) || bvh.most_lists < 1 ||
        bvh.most_lists > LOOPS_MOST_LISTS ||
        !fits_together(bvh, index.arcs.points.size(), slots, index.lattice.terrain))
        archive.refuse("the tree of technique 'loops' does not fit together");
    return bvh;
}

}  // namespace

void PreparedLoops::save(ArchiveWriter& archive, const std::string& prefix) const {
    const LoopsIndex& index = *index_;
    archive.add_value(
        prefix + "record",
        IndexRecord{index.lattice, index.heights, index.first_layer, index.segments, index.needs,
                    index.bvh.has_value(), detail_.has_eye, static_cast<uint32_t>(detail_.shows), 0});
    archive.add_value(prefix + "detail",
                      DetailRecord{detail_.uniform, detail_.screen, detail_.lens, detail_.lens_centre,
                                   detail_.lens_radius, detail_.heat_top, detail_.eye});
    archive.add_copy(prefix + "detail_steps", Span<const DetailStep>(detail_.steps));
    archive.add(prefix + "points", index.arcs.points.span());
    archive.add(prefix + "arc_offsets", index.arcs.offsets.span());
    archive.add(prefix + "arc_kinds", index.arcs.kinds.span());
    archive.add(prefix + "fill_offsets", index.arcs.fill_offsets.span());
    archive.add(prefix + "fill_arcs", index.arcs.fill_arcs.span());
    archive.add(prefix + "stroke_offsets", index.arcs.stroke_offsets.span());
    archive.add(prefix + "stroke_arcs", index.arcs.stroke_arcs.span());
    archive.add(prefix + "activations", index.activations.span());
    archive.add(prefix + "steps", index.steps.span());
    archive.add(prefix + "outlines", index.outlines.span());
    archive.add(prefix + "decals", slots_->decals.span());
    archive.add(prefix + "features", slots_->features.span());
    archive.add(prefix + "styles", slots_->styles.span());
    archive.add(prefix + "upwards", slots_->upwards.span());
    archive.add(prefix + "reaches", slots_->reaches.span());
    if (!index.bvh)
        return;
    archive.add_value(prefix + "bvh_record",
                      BvhRecord{index.bvh->counts, index.bvh->items,
                                static_cast<uint32_t>(index.bvh->primitives), index.bvh->most_lists});
    archive.add(prefix + "bvh_bases", index.bvh->bases.span());
    archive.add(prefix + "bvh_words", index.bvh->words.span());
}

std::unique_ptr<PreparedLoops> open_loops(const ArchiveReader& archive, const std::string& prefix) {
    const auto record = archive.value<IndexRecord>(prefix + "record");
    auto index = std::make_shared<LoopsIndex>();
    index->lattice = record.lattice;
    index->heights = record.heights;
    index->first_layer = record.first_layer;
    index->segments = record.segments;
    index->needs = record.needs;
    index->arcs.points = archive.array<LatticePoint>(prefix + "points");
    index->arcs.offsets = archive.array<uint32_t>(prefix + "arc_offsets");
    index->arcs.kinds = archive.array<ArcKind>(prefix + "arc_kinds");
    index->arcs.fill_offsets = archive.array<uint64_t>(prefix + "fill_offsets");
    index->arcs.fill_arcs = archive.array<uint32_t>(prefix + "fill_arcs");
    index->arcs.stroke_offsets = archive.array<uint64_t>(prefix + "stroke_offsets");
    index->arcs.stroke_arcs = archive.array<uint32_t>(prefix + "stroke_arcs");
    index->activations = archive.array<Activation>(prefix + "activations");
    index->steps = archive.array<Step>(prefix + "steps");
    index->outlines = archive.array<OutlineOrder>(prefix + "outlines");
    Slots slots;
    slots.decals = archive.array<Decal>(prefix + "decals");
    slots.features = archive.array<uint32_t>(prefix + "features");
    slots.styles = archive.array<Style>(prefix + "styles");
    slots.upwards = archive.array<uint32_t>(prefix + "upwards");
    slots.reaches = archive.array<float>(prefix + "reaches");
    const LoopsDetail detail = detail_of(archive.value<DetailRecord>(prefix + "detail"), record,
                                         archive.array<DetailStep>(prefix + "detail_steps"));
    if (record.shows > static_cast<uint32_t>(LoopsDetail::Shows::active))
        archive.refuse("the level of detail of technique 'loops' makes no sense");
    validate(detail);
    if (!is_lattice(index->lattice, index->heights) || !are_arcs(index->arcs) ||
        index->activations.size() != index->arcs.points.size() || !are_steps(index->arcs, index->steps))
        archive.refuse("the arcs of technique 'loops' do not fit together");
    if (!are_slots(slots, *index))
        archive.refuse("the looks of technique 'loops' do not fit its features");
    if (record.has_bvh != 0)
        index->bvh = open_bvh(archive, prefix, *index, slots.decals.size());
    return std::make_unique<PreparedLoops>(std::move(index), std::make_shared<const Slots>(std::move(slots)),
                                           detail);
}

}  // namespace decalgl::loops

#include "technique/static_bvh/data_group.h"

#include <optional>
#include <unordered_map>

#include "decalgl/core/error.h"
#include "technique/static_bvh/fill_group.h"
#include "technique/static_bvh/looks.h"
#include "technique/static_bvh/stroke_group.h"
#include "technique/static_bvh/walk_length.h"

namespace decalgl::bvh {
namespace {

DecalView view_of(const TechniqueInput& input, const Decal& decal) {
    return {&input.layers[decal.feature.layer - input.first_layer], decal};
}

GroupKind kind_of(const Layer& layer, const Decal& decal) {
    const bool together =
        layer.features.kind == FeatureKind::polygons && !layer.stroke.empty() &&
        (layer.outline_order == OutlineOrder::feature || layer.outline_mode != OutlineMode::normal);
    return together ? GroupKind::both : decal.is_stroke() ? GroupKind::strokes : GroupKind::fills;
}

class GroupBuilder {
public:
    GroupBuilder(const TechniqueInput& input, const DecalRun& run, PreparedBvh& bvh)
        : input_(input), bvh_(bvh), looks_(bvh.lattice, group_) {
        group_.kind = run.kind;
        if (run.kind != GroupKind::strokes)
            list_polygons(run);
        for (size_t i = run.decals.size(); i-- > 0;)
            add_slot(view_of(input, run.decals[i]));
        require_drawable(run);
    }

    DecalGroup build(const Stage& stage) {
        bvh_.charge.resize(bvh_.charge.bytes() + group_.looks.size() * sizeof(LookTexel) +
                           group_.styles.size() * (sizeof(Style) + sizeof(FeatureReference)));
        LatticeBox box;
        if (group_.kind != GroupKind::fills) {
            strokes_.emplace(input_, std::move(stroke_slots_), group_, bvh_.charge);
            strokes_->lay(bvh_.lattice);
            box = strokes_->common_box();
        }
        if (group_.kind != GroupKind::strokes) {
            fills_.emplace(input_, std::move(polygons_), group_, bvh_.charge);
            fills_->plant_quad_trees(bvh_.lattice, stage.part(0.0, 0.4));
            box.add(fills_->common_box());
        }
        group_.grid = DecalGrid::over(common(box, bvh_.lattice.terrain), input_.bvh.cells);
        grow(group_.cells, uint64_t{group_.grid.cell_count()} + 1, "cells", bvh_.charge);
        write_objects(stage.part(0.4, 0.8));
        plant_trees(group_, bvh_.charge, input_.threads, stage.part(0.8, 1.0),
                    [this](uint32_t cell, uint32_t object) { return box_of(cell, group_.object(object)); });
        return std::move(group_);
    }

private:
    void add_slot(const DecalView& decal) {
        const auto slot = static_cast<uint32_t>(group_.styles.size());
        const uint8_t* color = decal.color();
        const double width = decal.half_width() / bvh_.lattice.quantum;
        const double reach = decal.widest_half_width() / bvh_.lattice.quantum;
        const bool is_stroke = decal.decal.is_stroke();
        group_.styles.push_back({{color[0], color[1], color[2], color[3]},
                                 is_stroke && width == 0.0 ? -1.0F : static_cast<float>(width),
                                 looks_.place_of(decal),
                                 0});
        group_.needs.translucency |= color[3] != 255;
        group_.widest = std::max(group_.widest, static_cast<float>(reach));
        if (is_stroke)
            stroke_slots_.push_back({decal, slot, reach});
        if (is_stroke)
            group_.cut = decal.cut();
        if (group_.kind != GroupKind::strokes) {
            polygon_of_slot_.push_back(polygon_of_feature_.at(key_of(decal.decal.feature)));
            if (!is_stroke)
                polygons_.slots[polygon_of_slot_.back()] = slot;
        }
    }

    static uint64_t key_of(FeatureReference feature) {
        return uint64_t{feature.layer} << 32 | feature.feature;
    }

    // In draw order, which is that of fills and of outlines alike; some features have only one of them.
    void list_polygons(const DecalRun& run) {
        for (const Decal& decal : run.decals)
            polygon_of_feature_.try_emplace(key_of(decal.feature), 0);
        for (uint32_t l = run.decals[run.decals.size() - 1].feature.layer + 1;
             l-- > run.decals[0].feature.layer;) {
            const uint32_t place = l - input_.first_layer;
            const Layer& layer = input_.layers[place];
            for (size_t rank = layer.features.feature_count(); rank-- > 0;) {
                const auto feature = static_cast<uint32_t>(layer.feature_at(rank));
                const auto found = polygon_of_feature_.find(key_of({l, feature}));
                if (found == polygon_of_feature_.end())
                    continue;
                found->second = static_cast<uint32_t>(polygons_.features.size());
                polygons_.features.push_back({place, feature});
                polygons_.slots.push_back(NO_SLOT);
            }
        }
    }

    // Along a curve, segments come in no order in which translucent lines could be laid over each other.
    void require_drawable(const DecalRun& run) const {
        if (group_.kind == GroupKind::strokes && group_.needs.translucency &&
            input_.bvh.segment_order == SegmentOrder::hilbert && input_.bvh.composition == Composition::order)
            throw Error(
                ErrorKind::unsupported,
                "layer '" + view_of(input_, run.decals[0]).layer->name +
                    "' has translucent lines, which cannot be drawn in order while segment_order is "
                    "\"hilbert\"; use segment_order=\"importance\", composition=\"nearest\" or opaque "
                    "colours");
    }

    void write_objects(const Stage& stage) {
        std::optional<WorkingArray<uint32_t>> segments, exteriors;
        if (strokes_)
            segments.emplace(strokes_->write_segments(stage.part(0.0, fills_ ? 0.5 : 1.0)));
        if (fills_)
            exteriors.emplace(fills_->write_exteriors(stage.part(strokes_ ? 0.5 : 0.0, 1.0)));
        if (strokes_ && fills_)
            merge(segments->values, exteriors->values);
        else
            for (size_t cell = 0; cell < group_.cells.size(); ++cell)
                group_.cells[cell].object = (segments ? *segments : *exteriors).values[cell];
    }

    // Segments and exteriors of each cell in the order of their slots.
    void merge(const LargeArray<uint32_t>& segments, const LargeArray<uint32_t>& exteriors) {
        uint64_t total = 0;
        const uint32_t cells = group_.grid.cell_count();
        for (uint32_t cell = 0; cell <= cells; ++cell) {
            group_.cells[cell].object = static_cast<uint32_t>(total);
            if (cell == cells)
                break;
            total += segments[cell + 1] - segments[cell];
            for (uint32_t i = exteriors[cell]; i < exteriors[cell + 1]; ++i)
                total += group_.exteriors[i].slot != NO_SLOT ? 1 : 0;
            require_size(total, "objects in cells");
        }
        grow(group_.objects, total, "objects in cells", bvh_.charge);
        parallel_for(cells, cells_at_once, input_.threads, [&](size_t begin, size_t end) {
            for (size_t cell = begin; cell < end; ++cell)
                merge_cell({segments[cell], segments[cell + 1]}, {exteriors[cell], exteriors[cell + 1]},
                           &group_.objects[group_.cells[cell].object]);
        });
    }

    struct Places {
        uint32_t first;
        uint32_t end;
    };

    void merge_cell(Places segments, Places exteriors, Object* next) const {
        uint32_t fill = exteriors.first;
        const auto write_fills = [&](uint32_t below) {
            for (; fill < exteriors.end && fill_slot(fill) < below; ++fill)
                if (group_.exteriors[fill].slot != NO_SLOT)
                    *next++ = {fill, NO_EXTERIOR};
        };
        for (uint32_t i = segments.first; i < segments.end; ++i) {
            const uint32_t slot = group_.owner(group_.segments[i].first());
            write_fills(slot);
            *next++ = {i | STROKE_OBJECT, exterior_of(polygon_of_slot_[slot], exteriors)};
        }
        write_fills(NO_SLOT);
    }

    // Exteriors without a fill are passed by at any time.
    uint32_t fill_slot(uint32_t exterior) const {
        const uint32_t slot = group_.exteriors[exterior].slot;
        return slot == NO_SLOT ? 0 : slot;
    }

    uint32_t exterior_of(uint32_t polygon, Places exteriors) const {
        uint32_t low = exteriors.first, high = exteriors.end;
        while (low < high) {
            const uint32_t middle = low + (high - low) / 2;
            if (fills_->polygon_of(middle) < polygon)
                low = middle + 1;
            else
                high = middle;
        }
        return low < exteriors.end && fills_->polygon_of(low) == polygon ? low : NO_EXTERIOR;
    }

    LatticeBox box_of(uint32_t cell, Object object) const {
        return object.is_stroke() ? strokes_->box_of(object.segment()) : fills_->box_of(cell, object.place);
    }

    const TechniqueInput& input_;
    PreparedBvh& bvh_;
    DecalGroup group_;
    LookWriter looks_;
    std::vector<StrokeSlot> stroke_slots_;
    Polygons polygons_;
    std::unordered_map<uint64_t, uint32_t> polygon_of_feature_;
    std::vector<uint32_t> polygon_of_slot_;
    std::optional<StrokeBuilder> strokes_;
    std::optional<FillBuilder> fills_;
};

bool join(const TechniqueInput& input, const Decal& a, const Decal& b) {
    const GroupKind kind = kind_of(*view_of(input, a).layer, a);
    if (kind != kind_of(*view_of(input, b).layer, b))
        return false;
    const bool same_layer = a.feature.layer == b.feature.layer;
    if (kind == GroupKind::both)
        return same_layer;
    return input.bvh.passes == PassGrouping::kind || (same_layer && a.role == b.role);
}

}  // namespace

std::vector<DecalRun> cut_into_runs(const TechniqueInput& input, Span<const Decal> decals) {
    std::vector<DecalRun> runs;
    for (size_t first = 0, end = 1; first < decals.size(); first = end++) {
        while (end < decals.size() && join(input, decals[end - 1], decals[end]))
            ++end;
        runs.push_back({kind_of(*view_of(input, decals[first]).layer, decals[first]),
                        decals.subspan(first, end - first)});
    }
    return runs;
}

void add_group(const TechniqueInput& input, const DecalRun& run, PreparedBvh& bvh, const Stage& stage) {
    DecalGroup group = GroupBuilder(input, run, bvh).build(stage);
    group.first_slot = static_cast<uint32_t>(bvh.slots.size());
    for (size_t i = run.decals.size(); i-- > 0;)
        bvh.slots.push_back(run.decals[i].feature);
    bvh.pieces += group.segments.size() + group.exteriors.size() + group.interiors.size();
    bvh.longest_walk = std::max(bvh.longest_walk, longest_walk(group, input.threads));
    bvh.groups.push_back(std::move(group));
}

}  // namespace decalgl::bvh

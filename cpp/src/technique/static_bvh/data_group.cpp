#include "technique/static_bvh/data_group.h"

#include <unordered_map>

#include "decalgl/core/error.h"
#include "technique/static_bvh/fill_group.h"
#include "technique/static_bvh/looks.h"
#include "technique/static_bvh/stroke_group.h"

namespace decalgl::bvh {
namespace {

DecalView view_of(const TechniqueInput& input, const Decal& decal) {
    return {&input.layers[decal.feature.layer - input.first_layer], decal};
}

DecalGroup sealed(GroupBuild&& built, MemoryCharge&& charge) {
    DecalGroup group;
    group.kind = built.kind;
    group.cut = built.cut;
    group.needs = built.needs;
    group.slots = std::move(built.slots);
    group.styles = std::move(built.styles);
    group.looks = std::move(built.looks);
    group.widest = built.widest;
    group.grid = built.grid;
    group.cells = std::move(built.cells);
    group.nodes = std::move(built.nodes);
    group.objects = std::move(built.objects);
    group.vertices = std::move(built.vertices);
    group.owners = std::move(built.owners);
    group.segments = std::move(built.segments);
    group.ring_vertices = std::move(built.ring_vertices);
    group.exteriors = std::move(built.exteriors);
    group.interiors = std::move(built.interiors);
    group.quads = {std::move(built.quads.boxes), std::move(built.quads.links), std::move(built.quads.edges)};
    group.charge = std::make_shared<const MemoryCharge>(std::move(charge));
    for (const Decal& slot : group.slots)
        if (std::none_of(group.classes.begin(), group.classes.end(), [&](const DecalClass& each) {
                return each.layer == slot.feature.layer && each.role == slot.role;
            }))
            group.classes.push_back({slot.feature.layer, slot.role});
    summarise(group);
    return group;
}

class GroupBuilder {
public:
    GroupBuilder(const TechniqueInput& input, const DecalRun& run, const Lattice& lattice,
                 const GroupNeeds& needs)
        : input_(input),
          lattice_(lattice),
          charge_(input.memory, "static_bvh: prepared", 0),
          looks_(lattice, group_) {
        group_.kind = run.kind;
        group_.needs = needs;
        if (run.kind != GroupKind::strokes)
            list_polygons(run);
        for (size_t i = run.decals.size(); i-- > 0;)
            add_slot(view_of(input, run.decals[i]));
        require_drawable(group_.kind, group_.needs.translucency, input.bvh,
                         view_of(input, run.decals[0]).layer->name);
    }

    // Returns the part of the terrain that all objects lie in.
    LatticeBox lay(const Stage& stage) {
        charge_.resize(group_.looks.size() * sizeof(LookTexel) +
                       group_.styles.size() * (sizeof(Style) + sizeof(Decal)));
        LatticeBox box;
        if (group_.kind != GroupKind::fills) {
            strokes_.emplace(input_, std::move(stroke_slots_), group_, charge_);
            strokes_->lay(lattice_);
            box = strokes_->common_box();
        }
        if (group_.kind != GroupKind::strokes) {
            fills_.emplace(input_, std::move(polygons_), group_, charge_);
            fills_->plant_quad_trees(lattice_, stage);
            box.add(fills_->common_box());
        }
        return common(box, lattice_.terrain);
    }

    // Once it is laid: objects in the cells of a grid.
    DecalGroup build(const DecalGrid& grid, const Stage& stage) {
        group_.grid = grid;
        grow(group_.cells, grid.cell_count(), "cells", charge_);
        write_objects(stage.part(0.0, 0.7));
        plant_trees(group_, charge_, input_.threads, stage.part(0.7, 1.0),
                    [this](uint32_t cell, uint32_t object) { return box_of(cell, group_.object(object)); });
        return sealed(std::move(group_), std::move(charge_));
    }

    const GroupNeeds& needs() const { return group_.needs; }

private:
    void add_slot(const DecalView& decal) {
        const auto slot = static_cast<uint32_t>(group_.styles.size());
        const uint8_t* color = decal.color();
        const auto width = static_cast<float>(decal.half_width() / lattice_.quantum);
        const double reach = decal.widest_half_width() / lattice_.quantum;
        const bool is_stroke = decal.decal.is_stroke();
        group_.slots.push_back(decal.decal);
        group_.styles.push_back(style_of({color[0], color[1], color[2], color[3]}, width, is_stroke,
                                         looks_.place_of(decal), slot));
        group_.needs.translucency |= color[3] != 255 && color[3] != 0;
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

    void write_objects(const Stage& stage) {
        std::optional<WorkingArray<uint32_t>> segments, exteriors;
        if (strokes_)
            segments.emplace(strokes_->write_segments(stage.part(0.0, fills_ ? 0.5 : 1.0)));
        if (fills_)
            exteriors.emplace(fills_->write_exteriors(stage.part(strokes_ ? 0.5 : 0.0, 1.0)));
        if (strokes_ && fills_) {
            merge(segments->values, exteriors->values);
            return;
        }
        const LargeArray<uint32_t>& starts = (segments ? *segments : *exteriors).values;
        for (size_t cell = 0; cell < group_.cells.size(); ++cell)
            group_.cells[cell] = {0, starts[cell], starts[cell + 1] - starts[cell], 0};
    }

    // Segments and exteriors of each cell in the order of their slots.
    void merge(const LargeArray<uint32_t>& segments, const LargeArray<uint32_t>& exteriors) {
        uint64_t total = 0;
        const uint32_t cells = group_.grid.cell_count();
        for (uint32_t cell = 0; cell < cells; ++cell) {
            uint32_t count = segments[cell + 1] - segments[cell];
            for (uint32_t i = exteriors[cell]; i < exteriors[cell + 1]; ++i)
                count += group_.exteriors[i].slot != NO_SLOT ? 1 : 0;
            group_.cells[cell] = {0, static_cast<uint32_t>(total), count, 0};
            total += count;
            require_size(total, "objects in cells");
        }
        grow(group_.objects, total, "objects in cells", charge_);
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
    const Lattice& lattice_;
    MemoryCharge charge_;
    GroupBuild group_;
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

GroupKind kind_of(const Layer& layer, const Decal& decal) {
    const bool together =
        layer.features.kind == FeatureKind::polygons && !layer.stroke.empty() &&
        (layer.outline_order == OutlineOrder::feature || layer.outline_mode != OutlineMode::normal);
    return together ? GroupKind::both : decal.is_stroke() ? GroupKind::strokes : GroupKind::fills;
}

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

void require_drawable(GroupKind kind, bool translucency, const BvhOptions& options,
                      const std::string& layer) {
    if (kind == GroupKind::strokes && translucency && options.segment_order == SegmentOrder::hilbert &&
        options.composition == Composition::order)
        throw Error(ErrorKind::unsupported,
                    "layer '" + layer +
                        "' has translucent lines, which cannot be drawn in order while segment_order is "
                        "\"hilbert\"; use segment_order=\"importance\", composition=\"nearest\" or opaque "
                        "colours");
}

Style style_of(const std::array<uint8_t, 4>& color, float half_width, bool is_stroke, uint32_t look,
               uint32_t rank) {
    Style style{color, half_width, look, rank};
    if (is_stroke && half_width == 0.0F)
        style.color[3] = 0;
    if (!style.shows())
        style.half_width = -half_width;
    return style;
}

DecalGroup build_group(const TechniqueInput& input, const DecalRun& run, const Lattice& lattice,
                       const Stage& stage) {
    GroupBuilder builder(input, run, lattice, {});
    const LatticeBox box = builder.lay(stage.part(0.0, 0.4));
    return builder.build(DecalGrid::over(box, input.bvh.cells), stage.part(0.4, 1.0));
}

std::optional<DecalGroup> build_in_grid(const TechniqueInput& input, const DecalRun& run,
                                        const Lattice& lattice, const DecalGroup& like) {
    GroupNeeds needs = like.needs;
    needs.translucency = false;
    GroupBuilder builder(input, run, lattice, needs);
    Progress progress;
    const Stage all{&progress, 0.0, 1.0};
    const LatticeBox box = builder.lay(all);
    const bool is_alike = builder.needs().corners == needs.corners &&
                          builder.needs().patterns == needs.patterns &&
                          builder.needs().ground == needs.ground;
    if (!is_alike || !(box.empty() || like.grid.box.holds(box)))
        return std::nullopt;
    return builder.build(like.grid, all);
}

void summarise(DecalGroup& group) {
    group.has_shown = group.has_hidden = group.needs.translucency = false;
    for (size_t slot = 0; slot < group.styles.size(); ++slot) {
        const Style& style = group.styles[slot];
        group.has_shown |= style.shows();
        group.has_hidden |= !style.shows() && !group.slots[slot].is_stroke();
        group.needs.translucency |= style.shows() && style.color[3] != 255;
    }
    for (size_t slot = 0; group.needs.bands && slot < group.styles.size(); ++slot) {
        if (!group.slots[slot].is_stroke())
            continue;
        const StrokeLook look = stroke_look(group, group.styles[slot].look);
        for (uint32_t band = 0; band < look.band_count; ++band)
            group.needs.translucency |= look.bands[band][1] >> 24 != 255;
    }
}

}  // namespace decalgl::bvh

// Other looks for prepared layers: slots are what changes, and the index is shared.
#include <algorithm>
#include <cstring>

#include "decalgl/core/error.h"
#include "technique/draw_order.h"
#include "technique/loops/prepared_loops.h"

namespace decalgl::loops {
namespace {

[[noreturn]] void refuse(const std::string& what) {
    throw Error(ErrorKind::unsupported, "technique 'loops' " + what);
}

void apply(const DecalLook& look, const Decal& decal, double quantum, Style& style) {
    if (!look.colors.empty())
        std::memcpy(&style.color, look.color(decal.feature.feature), 4);
    if (look.widths.empty() || !decal.is_stroke())
        return;
    const double width = look.width(decal.feature.feature);
    style.half_width = std::max(static_cast<float>(0.5 * width / quantum), 1e-6F);
    if (width <= 0.0)
        style.color &= 0x00FFFFFFu;
}

// Puts the slots of a layer into another order; those of other layers stay where they are.
void reorder(const LayerLook& look, OutlineOrder outlines, Slots& slots) {
    const std::vector<uint32_t> order = upwards(slots.decals, {}, look.layer, look.draw_order, outlines);
    std::vector<uint32_t> places = order;
    std::sort(places.begin(), places.end());
    const std::vector<Decal> decals = slots.decals;
    const std::vector<Style> styles = slots.styles;
    for (size_t i = 0; i < places.size(); ++i) {
        slots.decals[places[i]] = decals[order[order.size() - 1 - i]];
        slots.styles[places[i]] = styles[order[order.size() - 1 - i]];
    }
}

}  // namespace

void Slots::complete(const LoopsIndex& index, const Arcs& arcs) {
    features.resize(decals.size());
    reaches.assign(arcs.count(), 0.0F);
    for (size_t slot = 0; slot < decals.size(); ++slot) {
        const FeatureReference& feature = decals[slot].feature;
        features[slot] = index.first_features[feature.layer - index.first_layer] + feature.feature;
        if (styles[slot].is_fill())
            continue;
        const auto reach = static_cast<float>(double{styles[slot].half_width} * index.lattice.quantum);
        for (const uint32_t arc : arcs.stroke_of(features[slot]))
            reaches[arc] = std::max(reaches[arc], reach);
    }
}

bool PreparedLoops::shows_anything() const {
    return std::any_of(slots_->styles.begin(), slots_->styles.end(),
                       [](const Style& style) { return style.is_shown(); });
}

LayerLook PreparedLoops::look_of(uint32_t layer, size_t features) const {
    LayerLook result;
    result.layer = layer;
    for (size_t slot = 0; slot < slots_->decals.size(); ++slot) {
        const Decal& decal = slots_->decals[slot];
        if (decal.feature.layer != layer || decal.feature.feature >= features)
            continue;
        DecalLook& look = *result.of(decal.role);
        look.colors.resize(4 * features, 0);
        std::memcpy(&look.colors[size_t{4} * decal.feature.feature], &slots_->styles[slot].color, 4);
        if (!decal.is_stroke())
            continue;
        look.widths.resize(features, 0.0);
        look.widths[decal.feature.feature] =
            2.0 * double{slots_->styles[slot].half_width} * index_->lattice.quantum;
    }
    return result;
}

std::shared_ptr<const Prepared> PreparedLoops::restyled(Span<const LayerLook> looks,
                                                        const MemoryAccount&) const {
    LoopsDetail detail = detail_;
    auto slots = std::make_shared<Slots>(*slots_);
    bool has_changes = false;
    for (const LayerLook& look : looks) {
        if (const auto* choice = dynamic_cast<const LoopsChoice*>(look.options.get()))
            detail = choice->detail;
        const bool has_widths = !look.stroke.widths.empty() || !look.casing.widths.empty();
        if (index_->bvh && has_widths)
            refuse("keeps its widths in a bvh; prepare the layer with bvh=None to change them");
        if (index_->bvh && !look.draw_order.empty())
            refuse("keeps its draw order in a bvh; prepare the layer with bvh=None to change it");
        for (size_t slot = 0; slot < slots->decals.size(); ++slot) {
            const Decal& decal = slots->decals[slot];
            if (decal.feature.layer == look.layer && look.of(decal.role) != nullptr)
                apply(*look.of(decal.role), decal, index_->lattice.quantum, slots->styles[slot]);
        }
        const size_t layer = look.layer - index_->first_layer;
        if (!look.draw_order.empty())
            reorder(look, index_->outlines[layer], *slots);
        has_changes = has_changes || has_widths || !look.draw_order.empty() || !look.fill.colors.empty() ||
                      !look.stroke.colors.empty() || !look.casing.colors.empty();
    }
    validate(detail);
    if (!has_changes)
        return std::make_shared<PreparedLoops>(index_, slots_, detail);
    slots->complete(*index_, index_->arcs);
    return std::make_shared<PreparedLoops>(index_, std::move(slots), detail);
}

std::shared_ptr<const Prepared> PreparedLoops::edited(const LayerEdit&, const MemoryAccount&) const {
    refuse("cannot edit its features; prepare the scene anew with the new ones, or use technique 'static'");
}

}  // namespace decalgl::loops

// Other looks for prepared layers: slots are what changes, and the index is shared.
#include <algorithm>
#include <cstring>

#include "decalgl/core/error.h"
#include "technique/decal_looks.h"
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

}  // namespace

void Slots::reach_along(const LoopsIndex& index) {
    std::vector<float> widest(index.arcs.count(), 0.0F);
    for (size_t slot = 0; slot < decals.size(); ++slot) {
        if (styles[slot].is_fill())
            continue;
        const auto reach = static_cast<float>(double{styles[slot].half_width} * index.lattice.quantum);
        for (const uint32_t arc : index.arcs.stroke_of(features[slot]))
            widest[arc] = std::max(widest[arc], reach);
    }
    reaches = std::move(widest);
}

bool PreparedLoops::shows_anything() const {
    return std::any_of(slots_->styles.begin(), slots_->styles.end(),
                       [](const Style& style) { return style.is_shown(); });
}

LayerLook PreparedLoops::look_of(uint32_t layer, size_t features) const {
    const Span<const Style> styles = slots_->styles;
    return layer_look(
        slots_->decals, layer, features,
        [&](size_t slot) { return reinterpret_cast<const uint8_t*>(&styles[slot].color); },
        [&](size_t slot) { return 2.0 * double{styles[slot].half_width} * index_->lattice.quantum; });
}

std::shared_ptr<const Prepared> PreparedLoops::restyled(Span<const LayerLook> looks,
                                                        const MemoryAccount&) const {
    LoopsDetail detail = detail_;
    Slots slots = *slots_;
    std::vector<Style> styles(slots.styles.begin(), slots.styles.end());
    bool has_colors = false, has_widths = false;
    for (const LayerLook& look : looks) {
        if (const auto* choice = dynamic_cast<const LoopsChoice*>(look.options.get()))
            detail = choice->detail;
        const bool is_widened = !look.stroke.widths.empty() || !look.casing.widths.empty();
        if (index_->bvh && is_widened)
            refuse("keeps its widths in a bvh; prepare the layer with bvh=None to change them");
        if (index_->bvh && !look.draw_order.empty())
            refuse("keeps its draw order in a bvh; prepare the layer with bvh=None to change it");
        for (size_t slot = 0; slot < styles.size(); ++slot) {
            const Decal& decal = slots.decals[slot];
            if (decal.feature.layer == look.layer && look.of(decal.role) != nullptr)
                apply(*look.of(decal.role), decal, index_->lattice.quantum, styles[slot]);
        }
        if (!look.draw_order.empty())
            slots.upwards = reordered(slots.decals, slots.upwards, look.layer, look.draw_order,
                                      index_->outlines[look.layer - index_->first_layer]);
        has_widths = has_widths || is_widened;
        has_colors = has_colors || !look.fill.colors.empty() || !look.stroke.colors.empty() ||
                     !look.casing.colors.empty();
    }
    validate(detail);
    if (has_colors || has_widths)
        slots.styles = std::move(styles);
    if (has_widths)
        slots.reach_along(*index_);
    return std::make_shared<PreparedLoops>(index_, std::make_shared<const Slots>(std::move(slots)), detail);
}

std::shared_ptr<const Prepared> PreparedLoops::edited(const LayerEdit&, const MemoryAccount&) const {
    refuse("cannot edit its features; prepare the scene anew with the new ones, or use technique 'static'");
}

}  // namespace decalgl::loops

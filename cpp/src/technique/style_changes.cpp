#include "technique/style_changes.h"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "decalgl/core/error.h"

namespace decalgl {
namespace {

[[noreturn]] void refuse(const std::string& what) {
    throw Error(ErrorKind::style, what + "; change it where the layer is added, and call preprocess(scene)");
}

bool is_round(const StrokeStyle& style) {
    return style.corner == Corner::round && style.cap == Cap::round && style.pattern.period == 0.0;
}

void require_places(const StrokeStyle& prepared, const StrokeStyle& wanted, CornerRoom room) {
    const LinePattern &before = prepared.pattern, &after = wanted.pattern;
    if (before.period != after.period || before.offset != after.offset)
        refuse("the dash= of a prepared line keeps its period and offset, here " +
               std::to_string(before.period) + " m and " + std::to_string(before.offset) +
               " m, since the index holds how far along it each vertex is");
    if (is_round(prepared) != is_round(wanted))
        refuse(
            "corner= cannot change where corners, caps and lines are prepared as round all over, nor become "
            "so");
    if (prepared.cap != wanted.cap)
        refuse("cap= is what the index was made for");
    const bool reaches_farther =
        prepared.corner != Corner::miter || wanted.miter_limit < prepared.miter_limit;
    if (wanted.corner == Corner::miter && reaches_farther)
        refuse("corner=\"miter\" reaches farther than the index was made for");
    if (room == CornerRoom::outline && wanted.corner == Corner::round && prepared.corner != Corner::round)
        refuse("corner=\"round\" reaches farther than index=\"bvh\" was made for");
    if (prepared.slope_correction != wanted.slope_correction)
        refuse("slope_correction= is what the index was made for");
    if (prepared.bands.empty() && !wanted.bands.empty())
        refuse("bands= needs a layer that was prepared with bands");
}

}  // namespace

bool has_styles(Span<const LayerLook> looks) {
    return std::any_of(looks.begin(), looks.end(), [](const LayerLook& look) {
        return look.fill.has_styles() || look.stroke.has_styles() || look.casing.has_styles();
    });
}

void require_styles(const LayerLook& look, const LayerSources* sources, Span<const Decal> slots,
                    CornerRoom room) {
    if (look.stroke.styles.empty() && look.casing.styles.empty())
        return;
    if (sources == nullptr)
        throw Error(ErrorKind::unsupported,
                    "a scene that was opened from a file keeps no styles to change; prepare it from its "
                    "data, with the file as cache");
    std::set<std::pair<const StrokeStyle*, const StrokeStyle*>> compared;
    for (const Decal& slot : slots) {
        if (slot.feature.layer != look.layer || !slot.is_stroke() || look.of(slot.role)->styles.empty())
            continue;
        const DecalLook& wanted = *look.of(slot.role);
        const uint32_t feature = slot.feature.feature;
        const std::pair<const StrokeStyle*, const StrokeStyle*> both{
            &sources->style_of(slot), &wanted.styles[wanted.style_of.empty() ? 0 : wanted.style_of[feature]]};
        if (compared.insert(both).second)
            require_places(*both.first, *both.second, room);
    }
}

std::vector<Layer> layers_of_styles(Span<const LayerLook> looks, size_t layer_count) {
    std::vector<Layer> layers(layer_count);
    const std::vector<uint8_t> any_color(4, 0);
    const auto take = [&](const DecalLook& look, Stroke& stroke) {
        if (look.styles.empty())
            return;
        stroke.colors = any_color;
        stroke.styles = look.styles;
        stroke.style_of = look.style_of;
    };
    for (const LayerLook& look : looks) {
        if (look.layer >= layer_count)
            continue;
        Layer& layer = layers[look.layer];
        take(look.stroke, layer.stroke);
        take(look.casing, layer.casing);
        if (!look.fill.hatches.empty())
            layer.fill = {any_color, look.fill.hatches, look.fill.hatch_of};
    }
    return layers;
}

}  // namespace decalgl

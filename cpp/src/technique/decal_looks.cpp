#include "technique/decal_looks.h"

#include <tuple>

namespace decalgl {

PlainLook look_of(const DecalView& view) {
    PlainLook look;
    std::copy_n(view.color(), 4, look.color.begin());
    look.half_width = static_cast<float>(view.half_width());
    return look;
}

LayerLook layer_look(Span<const Decal> decals, Span<const PlainLook> looks, uint32_t layer, size_t features) {
    return layer_look(
        decals, layer, features, [&](size_t i) { return looks[i].color.data(); },
        [&](size_t i) { return 2.0 * static_cast<double>(looks[i].half_width); });
}

std::vector<PlainLook> changed_looks(Span<const Decal> decals, Span<const PlainLook> before,
                                     Span<const LayerLook> changes) {
    std::vector<PlainLook> looks(before.begin(), before.end());
    for (const LayerLook& change : changes) {
        for (size_t i = 0; i < decals.size(); ++i) {
            const DecalLook* look =
                decals[i].feature.layer == change.layer ? change.of(decals[i].role) : nullptr;
            if (look == nullptr)
                continue;
            const uint32_t feature = decals[i].feature.feature;
            if (!look->colors.empty())
                std::copy_n(look->color(feature), 4, looks[i].color.begin());
            if (!look->widths.empty() && decals[i].is_stroke())
                looks[i].half_width = static_cast<float>(0.5 * look->width(feature));
        }
    }
    return looks;
}

std::vector<uint32_t> upwards(Span<const Decal> decals, uint32_t layer, Span<const int64_t> draw_order,
                              OutlineOrder outlines) {
    std::vector<size_t> rank(draw_order.size());
    for (size_t i = 0; i < draw_order.size(); ++i)
        rank[static_cast<size_t>(draw_order[i])] = i;
    std::vector<uint32_t> own;
    for (uint32_t i = 0; i < decals.size(); ++i)
        if (decals[i].feature.layer == layer && decals[i].feature.feature < rank.size())
            own.push_back(i);
    const auto key = [&](uint32_t i) {
        const Decal& decal = decals[i];
        const size_t place = rank[decal.feature.feature];
        const bool lies_below = decal.role == DecalRole::fill || decal.role == DecalRole::casing;
        const size_t above = lies_below ? 0 : 1;
        return outlines == OutlineOrder::feature ? std::tuple(place, above, decal.role)
                                                 : std::tuple(above, place, decal.role);
    };
    std::sort(own.begin(), own.end(), [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
    return own;
}

std::vector<uint32_t> reordered(Span<const Decal> decals, Span<const uint32_t> before, uint32_t layer,
                                Span<const int64_t> draw_order, OutlineOrder outlines) {
    const std::vector<uint32_t> own = upwards(decals, layer, draw_order, outlines);
    std::vector<bool> is_own(decals.size(), false);
    for (const uint32_t decal : own)
        is_own[decal] = true;
    std::vector<uint32_t> after(before.begin(), before.end());
    size_t next = 0;
    for (uint32_t& decal : after)
        if (is_own[decal])
            decal = own[next++];
    return after;
}

bool permutes(Span<const uint32_t> numbers, size_t count) {
    std::vector<bool> seen(count, false);
    for (const uint32_t number : numbers) {
        if (number >= count || seen[number])
            return false;
        seen[number] = true;
    }
    return numbers.size() == count;
}

}  // namespace decalgl

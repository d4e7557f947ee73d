// Other looks for a prepared index: new style records and, for another draw order, lists sorted anew. Whatever stays is
// shared with the index that it comes from.
#include <algorithm>
#include <cmath>
#include <mutex>
#include <string>
#include <utility>

#include "core/growing_array.h"
#include "decalgl/core/error.h"
#include "decalgl/core/large_array.h"
#include "decalgl/core/parallel.h"
#include "technique/decal_looks.h"
#include "technique/draw_order.h"
#include "technique/static_decals/draw_order.h"
#include "technique/static_decals/prepared_decals.h"
#include "technique/style_changes.h"

namespace decalgl {
namespace {

constexpr size_t block_slots = 1 << 15;

void apply(const DecalLook& look, const Decal& slot, double half_widths_per_metre, DecalStyle& style) {
    const size_t feature = slot.feature.feature;
    if (!look.widths.empty())
        style.half_width = static_cast<float>(look.width(feature) * half_widths_per_metre);
    if (!look.colors.empty())
        std::copy_n(look.color(feature), 4, style.color.begin());
    if (slot.is_stroke() && style.half_width <= 0.0F)
        style.color[3] = 0;
}

// What some decals have in common, to be joined with that of others.
struct StyleSummary {
    bool is_empty = true;  // nothing is shown
    bool has_one_color = true;
    bool has_translucency = false;
    bool has_hidden = false;
    bool has_strokes = false;
    std::array<uint8_t, 4> one_color{};
    float widest = 0.0F;
    float narrowest = 0.0F;

    void add_width(float half_width) {
        widest = has_strokes ? std::max(widest, half_width) : half_width;
        narrowest = has_strokes ? std::min(narrowest, half_width) : half_width;
        has_strokes = true;
    }

    void add(const DecalStyle& style, bool is_stroke) {
        if (is_stroke)
            add_width(style.half_width);
        if (style.color[3] == 0) {
            has_hidden = true;
            return;
        }
        has_translucency |= style.color[3] != 255;
        has_one_color &= is_empty || style.color == one_color;
        one_color = style.color;
        is_empty = false;
    }

    void add(const StyleSummary& other) {
        if (other.has_strokes) {
            add_width(other.widest);
            add_width(other.narrowest);
        }
        has_hidden |= other.has_hidden;
        has_translucency |= other.has_translucency;
        has_one_color &= other.has_one_color && (is_empty || other.is_empty || one_color == other.one_color);
        if (is_empty)
            one_color = other.one_color;
        is_empty &= other.is_empty;
    }
};

// Other records after those that there are, and which slots go by them.
void change_records(Span<const LayerLook> looks, PreparedDecals& decals, const MemoryAccount& memory) {
    const std::vector<Layer> layers = layers_of_styles(looks, decals.rules.size());
    TechniqueInput input;
    input.layers = layers;
    const StyleTable table(input, decals.grid);
    LargeArray<StyleTexel> records(decals.style_records.begin(), decals.style_records.end());
    if (records.empty())
        records.push_back({});
    const auto offset = static_cast<uint32_t>(records.size()) - 1;
    records.insert(records.end(), table.texels().begin() + 1, table.texels().end());
    LargeArray<uint32_t> kinds;
    kinds.resize(decals.slots.size());
    uint32_t flags = decals.style_flags & STYLE_WIDENED;
    for (uint32_t i = 0; i < kinds.size(); ++i) {
        const Decal& slot = decals.slots[i];
        kinds[i] = decals.kinds.empty() ? static_cast<uint32_t>(decals.scale_of(i)) : decals.kinds[i];
        const Layer& layer = layers[slot.feature.layer];
        const bool changes = slot.is_stroke()
                                 ? !(slot.role == DecalRole::casing ? layer.casing : layer.stroke).empty()
                                 : slot.role == DecalRole::fill && !layer.fill.empty();
        if (changes) {
            const uint32_t record = table.record_of(slot);
            kinds[i] = (record == 0 ? 0 : record + offset) << SCALE_BITS | (kinds[i] & SCALE_MASK);
        }
        flags |= records[kinds[i] >> SCALE_BITS][0];
    }
    decals.kinds = charged(SharedArray<uint32_t>(std::move(kinds)), memory, "static: prepared");
    decals.style_records = charged(SharedArray<StyleTexel>(std::move(records)), memory, "static: prepared");
    decals.style_flags = flags;
}

}  // namespace

void PreparedDecals::summarise_styles() {
    StyleSummary all;
    std::mutex mutex;
    parallel_for(styles.size(), block_slots, 0, [&](size_t begin, size_t end) {
        StyleSummary some;
        for (size_t slot = begin; slot < end; ++slot) {
            if (slots[slot].role != DecalRole::clip)
                some.add(styles[slot], slots[slot].is_stroke());
        }
        const std::lock_guard<std::mutex> lock(mutex);
        all.add(some);
    });
    widest = all.widest;
    narrowest = all.narrowest;
    has_one_color = all.has_one_color;
    has_translucency = all.has_translucency;
    has_hidden = all.has_hidden;
    has_shown = !all.is_empty;
    one_color = all.one_color;
}

LayerLook PreparedDecals::look_of(uint32_t layer, size_t features) const {
    const double metres = layer < rules.size() ? grid.quantum / rules[layer].half_width_per_width : 0.0;
    return layer_look(
        slots, layer, features, [&](size_t i) { return styles[i].color.data(); },
        [&](size_t i) { return static_cast<double>(styles[i].half_width) * metres; });
}

std::shared_ptr<const Prepared> PreparedDecals::restyled(Span<const LayerLook> looks,
                                                         const MemoryAccount& memory) const {
    std::vector<const LayerLook*> look_of(rules.size(), nullptr);
    for (const LayerLook& look : looks) {
        if (look.layer >= rules.size())
            continue;
        require_widths(look, rules[look.layer]);
        require_styles(look, sources.get(), slots, CornerRoom::disc);
        look_of[look.layer] = &look;
    }
    auto result = std::make_shared<PreparedDecals>(*this);
    LargeArray<DecalStyle> changed;
    changed.resize(styles.size());
    parallel_for(styles.size(), block_slots, 0, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            changed[i] = styles[i];
            const Decal& slot = slots[i];
            const LayerLook* look =
                slot.feature.layer < look_of.size() ? look_of[slot.feature.layer] : nullptr;
            if (look != nullptr && look->of(slot.role) != nullptr)
                apply(*look->of(slot.role), slot,
                      rules[slot.feature.layer].half_width_per_width / grid.quantum, changed[i]);
        }
    });
    result->styles = charged(SharedArray<DecalStyle>(std::move(changed)), memory, "static: prepared");
    result->look_token = std::make_shared<const LookToken>();
    if (has_styles(looks))
        change_records(looks, *result, memory);
    if (has_styles(looks) || std::any_of(looks.begin(), looks.end(), has_widths))
        result->shape_token = std::make_shared<const ShapeToken>();
    result->summarise_styles();
    for (const LayerLook& look : looks)
        if (!look.draw_order.empty() && look.layer < rules.size())
            result->ranks = reordered_ranks(look, rules[look.layer], slots, result->ranks);
    const bool is_reordered = std::any_of(looks.begin(), looks.end(),
                                          [](const LayerLook& look) { return !look.draw_order.empty(); });
    if (is_reordered)
        sort_lists(*result, memory);
    return result;
}

}  // namespace decalgl

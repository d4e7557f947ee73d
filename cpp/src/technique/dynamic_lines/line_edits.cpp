// Edits and draw orders: lines stand in draw order, so both write the arrays anew. Whatever stays is copied as it is;
// nothing is cut or looked up again but what comes.
#include "technique/dynamic_lines/line_edits.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "core/growing_array.h"
#include "decalgl/core/error.h"

namespace decalgl {
namespace {

constexpr uint32_t none = std::numeric_limits<uint32_t>::max();

// Casings of a layer lie below all its strokes.
std::pair<uint32_t, bool> level_of(const Decal& decal) {
    return {decal.feature.layer, decal.role == DecalRole::stroke};
}

// A slot as it will be: with the lines of an old one, or with new geometry.
struct NextSlot {
    Decal decal;
    LineStyle style;
    uint32_t old = none;
    uint32_t geometry = none;
};

std::vector<NextSlot> slots_of(const PreparedLines& lines) {
    std::vector<NextSlot> slots;
    for (uint32_t slot = 0; slot < lines.slots.size(); ++slot)
        slots.push_back({lines.slots[slot], lines.styles[slot], slot, none});
    return slots;
}

// Where each slot's lines begin, and where the last one's end.
std::vector<size_t> first_lines(const PreparedLines& lines) {
    std::vector<size_t> first(lines.slots.size() + 1, 0);
    for (const LineRecord& line : lines.lines)
        ++first[line.slot + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    return first;
}

std::shared_ptr<PreparedLines> rebuilt(const PreparedLines& before, const std::vector<NextSlot>& next,
                                       const Features& geometry, const MemoryAccount& memory) {
    auto result = std::make_shared<PreparedLines>(before);
    const std::vector<size_t> first = first_lines(before);
    LineWriter writer(before.lattice, memory);
    std::vector<Decal> slots;
    std::vector<LineStyle> styles;
    for (const NextSlot& slot : next) {
        const auto place = static_cast<uint32_t>(slots.size());
        if (slot.geometry != none)
            writer.add(geometry, slot.geometry, purpose_of(slot.style, place, before.patterns));
        else
            writer.copy(before.lines.span().subspan(first[slot.old], first[slot.old + 1] - first[slot.old]),
                        before.vertices, place);
        slots.push_back(slot.decal);
        styles.push_back(slot.style);
    }
    const auto keep = [&](auto& values) {
        using Value = typename std::decay_t<decltype(values)>::value_type;
        return charged(SharedArray<Value>(std::move(values)), memory, "dynamic: prepared");
    };
    result->vertices = keep(writer.vertices);
    result->lines = keep(writer.lines);
    result->slots = keep(slots);
    result->styles = keep(styles);
    result->segments = writer.segments;
    result->summarise();
    return result;
}

// Slots of the features that an edit adds, with the looks that it gives them.
void add_features(const LayerEdit& edit, const LineTemplate& like, std::vector<NextSlot>& slots) {
    const uint8_t hidden[4] = {0, 0, 0, 0};
    const auto add = [&](DecalRole role, const std::vector<LineStyle>& records, const DecalLook& look) {
        for (uint32_t added = 0; added < edit.added_count(); ++added) {
            const Decal decal{{edit.layer, like.features + added}, role};
            for (LineStyle style : records) {
                set_color(style, look.colors.empty() ? hidden : look.color(added));
                set_width(style, look.widths.empty() ? 0.0 : look.width(added));
                slots.push_back({decal, style, none, static_cast<uint32_t>(edit.replaced.size()) + added});
            }
        }
    };
    add(DecalRole::casing, like.casing, edit.casing);
    add(DecalRole::stroke, like.stroke, edit.stroke);
}

// The slots that are left of those before; replaced features have new geometry.
std::vector<NextSlot> slots_after(const PreparedLines& before, const LayerEdit& edit) {
    const std::unordered_set<uint32_t> removed(edit.removed.begin(), edit.removed.end());
    std::unordered_map<uint32_t, uint32_t> replaced;
    for (uint32_t i = 0; i < edit.replaced.size(); ++i)
        replaced[edit.replaced[i]] = i;
    std::vector<NextSlot> next;
    for (NextSlot& slot : slots_of(before)) {
        const FeatureReference feature = slot.decal.feature;
        const bool is_own = feature.layer == edit.layer;
        if (is_own && removed.count(feature.feature) != 0)
            continue;
        const auto moved = replaced.find(feature.feature);
        if (is_own && moved != replaced.end())
            slot.geometry = moved->second;
        next.push_back(slot);
    }
    return next;
}

}  // namespace

std::shared_ptr<PreparedLines> reordered(const PreparedLines& before, uint32_t layer,
                                         Span<const int64_t> draw_order, const MemoryAccount& memory) {
    std::vector<size_t> ranks(draw_order.size(), 0);
    for (size_t rank = 0; rank < draw_order.size(); ++rank)
        ranks[static_cast<size_t>(draw_order[rank])] = rank;
    std::vector<NextSlot> slots = slots_of(before);
    const auto rank_of = [&](const NextSlot& slot) {
        const FeatureReference feature = slot.decal.feature;
        return feature.layer == layer && feature.feature < ranks.size() ? ranks[feature.feature] : 0;
    };
    std::stable_sort(slots.begin(), slots.end(), [&](const NextSlot& a, const NextSlot& b) {
        return std::make_pair(level_of(a.decal), rank_of(a)) < std::make_pair(level_of(b.decal), rank_of(b));
    });
    return rebuilt(before, slots, Features{}, memory);
}

std::shared_ptr<const Prepared> PreparedLines::edited(const LayerEdit& edit,
                                                      const MemoryAccount& memory) const {
    if (!templates)
        throw Error(
            ErrorKind::unsupported,
            "dynamic lines that were opened from a file cannot be edited; prepare the scene from its data");
    auto next_templates = std::make_shared<LineTemplates>(*templates);
    LineTemplate& like = next_templates->at(edit.layer);
    std::vector<NextSlot> next = slots_after(*this, edit);
    add_features(edit, like, next);
    std::stable_sort(next.begin(), next.end(), [](const NextSlot& a, const NextSlot& b) {
        return level_of(a.decal) < level_of(b.decal);
    });
    auto result = rebuilt(*this, next, edit.geometry, memory);
    like.features += static_cast<uint32_t>(edit.added_count());
    result->templates = std::move(next_templates);
    return result;
}

}  // namespace decalgl

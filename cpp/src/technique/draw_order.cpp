#include "technique/draw_order.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

namespace decalgl {
namespace {

constexpr size_t roles = 4;  // at least as many as DecalRole has
constexpr uint32_t none = 0xFFFFFFFFU;

uint32_t rank_of(Span<const uint32_t> ranks, uint32_t slot) {
    return ranks.empty() ? slot : ranks[slot];
}

bool lies_below(DecalRole role) {
    return role == DecalRole::fill || role == DecalRole::casing;
}

// The slots of one layer by feature and role.
class LayerSlots {
public:
    LayerSlots(Span<const Decal> decals, Span<const uint32_t> ranks, uint32_t layer, size_t features)
        : slots_(roles * features, none) {
        for (uint32_t slot = 0; slot < decals.size(); ++slot) {
            const Decal& decal = decals[slot];
            const auto role = static_cast<size_t>(decal.role);
            if (decal.feature.layer == layer && decal.feature.feature < features && role < roles &&
                rank_of(ranks, slot) != no_rank)
                slots_[roles * decal.feature.feature + role] = slot;
        }
    }

    // Calls on_slot for the decals of a feature that lie below outlines and strokes, or for the others, upwards; what cuts a
    // decal off comes right above it.
    template <typename OnSlot>
    void for_each(int64_t feature, bool below, OnSlot on_slot) const {
        const uint32_t* first = &slots_[roles * static_cast<size_t>(feature)];
        for (size_t role = 0; role < roles; ++role)
            if (lies_below(static_cast<DecalRole>(role)) == below && first[role] != none)
                on_slot(first[role]);
    }

private:
    std::vector<uint32_t> slots_;
};

// Where a decal stands among those of all layers, roughly: decals of one class lie next to each other.
std::pair<uint32_t, int> class_of(const Decal& decal, Span<const LayerRules> rules) {
    const bool by_feature = rules[decal.feature.layer].outlines_by_feature != 0;
    return {decal.feature.layer, by_feature || lies_below(decal.role) ? 0 : 1};
}

}  // namespace

std::vector<uint32_t> upwards(Span<const Decal> slots, Span<const uint32_t> ranks, uint32_t layer,
                              Span<const int64_t> draw_order, OutlineOrder outlines) {
    const LayerSlots own(slots, ranks, layer, draw_order.size());
    std::vector<uint32_t> result;
    const auto add = [&](uint32_t slot) { result.push_back(slot); };
    if (outlines == OutlineOrder::feature) {
        for (const int64_t feature : draw_order)
            for (const bool below : {true, false})
                own.for_each(feature, below, add);
    } else {
        for (const bool below : {true, false})
            for (const int64_t feature : draw_order)
                own.for_each(feature, below, add);
    }
    return result;
}

std::vector<uint32_t> reordered(Span<const Decal> slots, Span<const uint32_t> before, uint32_t layer,
                                Span<const int64_t> draw_order, OutlineOrder outlines) {
    const std::vector<uint32_t> own = upwards(slots, {}, layer, draw_order, outlines);
    std::vector<bool> is_own(slots.size(), false);
    for (const uint32_t slot : own)
        is_own[slot] = true;
    std::vector<uint32_t> after(before.begin(), before.end());
    size_t next = 0;
    for (uint32_t& slot : after)
        if (is_own[slot])
            slot = own[next++];
    return after;
}

LargeArray<uint32_t> reordered_ranks(const LayerLook& look, const LayerRules& rules, Span<const Decal> slots,
                                     Span<const uint32_t> ranks) {
    const std::vector<uint32_t> own =
        upwards(slots, ranks, look.layer, look.draw_order,
                rules.outlines_by_feature != 0 ? OutlineOrder::feature : OutlineOrder::layer);
    LargeArray<uint32_t> result;
    result.resize(slots.size());
    for (uint32_t slot = 0; slot < result.size(); ++slot)
        result[slot] = rank_of(ranks, slot);
    // They share the ranks that they had, of which no two are the same: marked, they need no sorting.
    std::vector<bool> is_theirs;
    for (const uint32_t slot : own) {
        if (result[slot] >= is_theirs.size())
            is_theirs.resize(size_t{result[slot]} + 1);
        is_theirs[result[slot]] = true;
    }
    size_t next = own.size();
    for (uint32_t rank = 0; rank < is_theirs.size(); ++rank)
        if (is_theirs[rank])
            result[own[--next]] = rank;
    return result;
}

LargeArray<uint32_t> ranks_with_added(Span<const Decal> slots, Span<const uint32_t> ranks,
                                      Span<const Decal> added, Span<const LayerRules> rules) {
    // The ranks above a class: those that decals of higher classes have.
    std::map<std::pair<uint32_t, int>, uint32_t> above;
    for (const Decal& decal : added)
        above[class_of(decal, rules)] = 0;
    uint32_t end = 0;
    for (uint32_t slot = 0; slot < slots.size(); ++slot) {
        const uint32_t rank = rank_of(ranks, slot);
        if (rank == no_rank)
            continue;
        end = std::max(end, rank + 1);
        for (auto& [one, count] : above)
            if (class_of(slots[slot], rules) > one)
                count = std::max(count, rank + 1);
    }
    std::vector<uint32_t> shift(size_t{end} + 1, 0);
    for (const Decal& decal : added)
        ++shift[above[class_of(decal, rules)]];
    for (size_t i = 1; i < shift.size(); ++i)
        shift[i] += shift[i - 1];
    LargeArray<uint32_t> result;
    result.resize(slots.size() + added.size());
    for (uint32_t slot = 0; slot < slots.size(); ++slot) {
        const uint32_t rank = rank_of(ranks, slot);
        result[slot] = rank == no_rank ? no_rank : rank + shift[rank];
    }
    // They come topmost first, and so do their classes.
    for (uint32_t i = 0; i < added.size(); ++i)
        result[slots.size() + i] = above[class_of(added[i], rules)] + i;
    return result;
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

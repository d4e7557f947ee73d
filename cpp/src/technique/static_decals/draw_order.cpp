#include "technique/static_decals/draw_order.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "core/growing_array.h"
#include "decalgl/core/large_array.h"
#include "decalgl/core/parallel.h"

namespace decalgl {
namespace {

constexpr size_t block_cells = 1 << 12;

constexpr size_t roles = 4;  // at least as many as DecalRole has
constexpr uint32_t none = std::numeric_limits<uint32_t>::max();

// The slots of one layer by feature and role.
class LayerSlots {
public:
    LayerSlots(const PreparedDecals& decals, uint32_t layer, size_t features)
        : slots_(roles * features, none) {
        for (uint32_t slot = 0; slot < decals.slots.size(); ++slot) {
            const Decal& decal = decals.slots[slot];
            if (decal.feature.layer == layer && decal.feature.feature < features &&
                static_cast<size_t>(decal.role) < roles)
                slots_[roles * decal.feature.feature + static_cast<size_t>(decal.role)] = slot;
        }
    }

    // Calls on_slot for the decals of a feature that lie below outlines and strokes, or for the others, upwards; what cuts a
    // decal off comes right above it.
    template <typename OnSlot>
    void for_each(int64_t feature, bool lie_below, OnSlot on_slot) const {
        const uint32_t* first = &slots_[roles * static_cast<size_t>(feature)];
        for (size_t role = 0; role < roles; ++role) {
            const bool is_below = role == static_cast<size_t>(DecalRole::fill) ||
                                  role == static_cast<size_t>(DecalRole::casing);
            if (is_below == lie_below && first[role] != none)
                on_slot(first[role]);
        }
    }

private:
    std::vector<uint32_t> slots_;
};

}  // namespace

void ListSorter::sort(uint32_t* words, size_t count) {
    groups_.clear();
    size_t end = 0;
    for (; end < count && words[end] != LIST_END; ++end) {
        if ((words[end] & HEADER) == 0)
            continue;
        if (!groups_.empty())
            groups_.back().end = end;
        groups_.push_back({decals_.rank_of(words[end] & SLOT_MASK), end, end});
    }
    if (groups_.empty())
        return;
    groups_.back().end = end;
    const auto is_above = [](const Group& a, const Group& b) { return a.rank < b.rank; };
    if (std::is_sorted(groups_.begin(), groups_.end(), is_above))
        return;
    std::sort(groups_.begin(), groups_.end(), is_above);
    sorted_.clear();
    for (const Group& group : groups_)
        sorted_.insert(sorted_.end(), words + group.begin, words + group.end);
    std::copy(sorted_.begin(), sorted_.end(), words);
}

void reorder(const LayerLook& look, PreparedDecals& decals) {
    const LayerSlots layer(decals, look.layer, look.draw_order.size());
    std::vector<uint32_t> upwards;
    if (decals.rules[look.layer].outlines_by_feature != 0) {
        for (const int64_t feature : look.draw_order)
            for (const bool lie_below : {true, false})
                layer.for_each(feature, lie_below, [&](uint32_t slot) { upwards.push_back(slot); });
    } else {
        for (const bool lie_below : {true, false})
            for (const int64_t feature : look.draw_order)
                layer.for_each(feature, lie_below, [&](uint32_t slot) { upwards.push_back(slot); });
    }
    LargeArray<uint32_t> ranks;
    ranks.resize(decals.slots.size());
    for (uint32_t slot = 0; slot < ranks.size(); ++slot)
        ranks[slot] = decals.rank_of(slot);
    // They share the ranks that they had.
    std::vector<bool> is_theirs(ranks.size(), false);
    for (const uint32_t slot : upwards)
        is_theirs[ranks[slot]] = true;
    size_t left = upwards.size();
    for (uint32_t rank = 0; rank < is_theirs.size(); ++rank)
        if (is_theirs[rank])
            ranks[upwards[--left]] = rank;
    decals.ranks = std::move(ranks);
}

void sort_lists(PreparedDecals& decals, const MemoryAccount& memory) {
    const SharedArray<uint32_t> before = decals.words;
    LargeArray<uint32_t> words;
    words.resize(before.size());
    parallel_for(words.size(), block_cells * 64, 0, [&](size_t begin, size_t end) {
        std::copy(before.begin() + begin, before.begin() + end,
                  words.begin() + static_cast<std::ptrdiff_t>(begin));
    });
    parallel_for(decals.cells.size(), block_cells, 0, [&](size_t begin, size_t end) {
        ListSorter sorter(decals);
        for (size_t i = begin; i < end; ++i) {
            if (decals.cells[i] == EMPTY_LIST)
                continue;
            const Span<const uint32_t> list = decals.list(decals.cells[i]);
            sorter.sort(words.data() + (list.data() - before.data()), list.size());
        }
    });
    decals.words = charged(SharedArray<uint32_t>(std::move(words)), memory, "static: prepared");
    decals.growing_words = {};
}

}  // namespace decalgl

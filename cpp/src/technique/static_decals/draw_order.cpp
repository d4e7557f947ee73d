#include "technique/static_decals/draw_order.h"

#include <algorithm>
#include <tuple>
#include <utility>
#include <vector>

#include "core/growing_array.h"
#include "decalgl/core/large_array.h"
#include "decalgl/core/parallel.h"

namespace decalgl {
namespace {

constexpr size_t block_cells = 1 << 12;

// Where a decal stands in its layer, from bottom to top: by its role and then by its feature, or the other way round. What
// cuts a decal off stands right above it.
struct Place {
    int64_t first;
    int64_t second;
    int clips;
    uint32_t slot;
};

bool operator<(const Place& a, const Place& b) {
    return std::tie(a.first, a.second, a.clips) < std::tie(b.first, b.second, b.clips);
}

Place place_of(const Decal& decal, uint32_t slot, int64_t feature_place, bool by_feature) {
    const bool lies_below = decal.role == DecalRole::fill || decal.role == DecalRole::casing;
    const int64_t role = lies_below ? 0 : 1;
    const int clips = lies_below || decal.role == DecalRole::stroke ? 0 : 1;
    return by_feature ? Place{feature_place, role, clips, slot} : Place{role, feature_place, clips, slot};
}

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
    std::stable_sort(groups_.begin(), groups_.end(), is_above);
    sorted_.clear();
    for (const Group& group : groups_)
        sorted_.insert(sorted_.end(), words + group.begin, words + group.end);
    std::copy(sorted_.begin(), sorted_.end(), words);
}

void reorder(const LayerLook& look, PreparedDecals& decals) {
    std::vector<int64_t> place_of_feature(look.draw_order.size());
    for (size_t i = 0; i < look.draw_order.size(); ++i)
        place_of_feature[static_cast<size_t>(look.draw_order[i])] = static_cast<int64_t>(i);
    const bool by_feature = decals.rules[look.layer].outlines_by_feature != 0;
    LargeArray<uint32_t> ranks;
    ranks.resize(decals.slots.size());
    std::vector<Place> places;
    std::vector<uint32_t> taken;
    for (uint32_t slot = 0; slot < ranks.size(); ++slot) {
        ranks[slot] = decals.rank_of(slot);
        const Decal& decal = decals.slots[slot];
        if (decal.feature.layer != look.layer)
            continue;
        places.push_back(place_of(decal, slot, place_of_feature[decal.feature.feature], by_feature));
        taken.push_back(ranks[slot]);
    }
    std::sort(places.begin(), places.end());
    std::sort(taken.begin(), taken.end());
    for (size_t i = 0; i < places.size(); ++i)
        ranks[places[i].slot] = taken[taken.size() - 1 - i];
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

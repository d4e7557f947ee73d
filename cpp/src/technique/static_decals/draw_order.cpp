#include "technique/static_decals/draw_order.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/growing_array.h"
#include "decalgl/core/large_array.h"
#include "decalgl/core/parallel.h"

namespace decalgl {
namespace {

constexpr size_t block_cells = 1 << 12;

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

void sort_lists(PreparedDecals& decals, const MemoryAccount& memory) {
    const SharedArray<uint32_t> before = decals.words.values();
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
}

}  // namespace decalgl

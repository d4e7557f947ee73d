#include "technique/static_decals/cell_list_builder.h"

#include <algorithm>
#include <limits>

namespace decalgl {
namespace {

constexpr uint32_t no_slot = std::numeric_limits<uint32_t>::max();
constexpr uint32_t texel_words = 4;
constexpr size_t most_words_of_an_edge = 5;  // header, two points and their pattern

// Lists that are too long for their count need an end to be seen by.
uint32_t texels_of(uint32_t words) {
    const uint32_t texels = (words + texel_words - 1) / texel_words;
    return texels < COUNT_ESCAPE ? texels : words / texel_words + 1;
}

}  // namespace

void CellListBuilder::begin(int level) {
    level_ = level;
    cells_.assign(size_t{1} << (2 * level), {no_slot, 0, no_point, 0});
    word_count_ = 0;
    edges_ = 0;
}

void CellListBuilder::reserve_words() {
    if (word_count_ + most_words_of_an_edge > words_.size())
        words_.resize(std::max<size_t>(2 * words_.size(), 1 << 12));
}

void CellListBuilder::open_group(uint32_t cell, uint32_t slot, uint32_t flags) {
    cells_[cell].slot = slot;
    cells_[cell].header = static_cast<uint32_t>(word_count_);
    cells_[cell].last = no_point;
    add_word(cell, HEADER | flags | slot);
}

void CellListBuilder::add_edge(uint32_t cell, uint32_t slot, uint32_t flags, uint32_t from, uint32_t to,
                               const PatternWords& pattern) {
    begin_run(cell, slot, flags, from, pattern);
    if (from != to)
        add_word(cell, to);
    cells_[cell].last = to;
    ++edges_;
}

void CellListBuilder::add_dot(uint32_t cell, uint32_t slot, uint32_t at, const PatternWords& pattern) {
    begin_run(cell, slot, LINE, at, pattern);
    add_word(cell, at);
}

// Goes on from a point, or moves there.
void CellListBuilder::begin_run(uint32_t cell, uint32_t slot, uint32_t flags, uint32_t from,
                                const PatternWords& pattern) {
    reserve_words();
    if (cells_[cell].slot != slot)
        open_group(cell, slot, flags);
    if (cells_[cell].last == from)
        return;
    add_word(cell, from | MOVE);
    for (size_t i = 0; i < pattern.count; ++i)
        add_word(cell, pattern.words[i]);
    cells_[cell].last = from;
}

void CellListBuilder::add_covers(uint32_t cell, uint32_t slot, uint32_t flags) {
    reserve_words();
    if (cells_[cell].slot != slot)
        open_group(cell, slot, flags);
    words_[cells_[cell].header].word |= COVERS;
}

void CellListBuilder::finish(CellChunk& chunk) {
    chunk.bucket_entries.push_back(static_cast<uint32_t>(chunk.cells.size()) << LEVEL_BITS |
                                   static_cast<uint32_t>(level_));
    chunk.edges += edges_;
    auto texel = static_cast<uint32_t>(chunk.words.size() / texel_words);
    cursors_.clear();
    for (const Cell& cell : cells_) {
        const uint32_t texels = texels_of(cell.count);
        chunk.cells.push_back(texels == 0 ? EMPTY_LIST
                                          : texel << COUNT_BITS | std::min(texels, COUNT_ESCAPE));
        cursors_.push_back(texel * texel_words);
        texel += texels;
        chunk.longest_list = std::max(chunk.longest_list, cell.count);
    }
    chunk.words.resize(size_t{texel} * texel_words, LIST_END);
    uint32_t* words = chunk.words.data();
    for (size_t i = 0; i < word_count_; ++i)
        words[cursors_[words_[i].cell]++] = words_[i].word;
}

}  // namespace decalgl

// The lists of one bucket's cells on their way into an index.
//
//     words in the order they come     a3  b1  a3  a3  b1 ...      (cell, word)
//     sorted by cell                   a3 a3 a3 | b1 b1 | ...      padded to texels
//
// Words are made once, feature after feature from the topmost, and scattered while they are in the cache.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "decalgl/core/large_array.h"
#include "technique/static_decals/bucket_grid.h"

namespace decalgl {

// A flag for each cell of a bucket.
using CellMask = std::vector<uint8_t>;

// The lists of some neighbouring buckets: entries count from the chunk's own first cell and texel.
struct CellChunk {
    std::vector<uint32_t> bucket_entries;
    LargeArray<uint32_t> cells;
    LargeArray<uint32_t> words;
    uint64_t edges = 0;
    uint32_t longest_list = 0;  // words
};

// What follows a MOVE of a stroke with a pattern (style_records.h).
struct PatternWords {
    std::array<uint32_t, 2> words{};
    size_t count = 0;

    void add(uint32_t word) { words[count++] = word; }
};

class CellListBuilder {
public:
    // Begins a bucket of 4^level empty cells.
    void begin(int level);

    int level() const { return level_; }
    size_t cell_count() const { return cells_.size(); }
    uint32_t cell_at(int64_t column, int64_t row) const {
        return static_cast<uint32_t>(row << level_ | column);
    }

    // `from` and `to`: points as words, without MOVE. `flags`: LINE, CLIP or none. `pattern`: as it is at `from`.
    void add_edge(uint32_t cell, uint32_t slot, uint32_t flags, uint32_t from, uint32_t to,
                  const PatternWords& pattern = {});
    // Lets the next edge move to its beginning, and tell its pattern, even where the run has come to.
    void lift_pen(uint32_t cell, uint32_t slot) {
        if (cells_[cell].slot == slot)
            cells_[cell].last = no_point;
    }
    // A joined stroke's round end, or a dot.
    void add_dot(uint32_t cell, uint32_t slot, uint32_t at, const PatternWords& pattern);
    void add_covers(uint32_t cell, uint32_t slot, uint32_t flags);
    bool has_group(uint32_t cell, uint32_t slot) const { return cells_[cell].slot == slot; }
    bool is_covered(uint32_t cell, uint32_t slot) const {
        return cells_[cell].slot == slot && (words_[cells_[cell].header].word & COVERS) != 0;
    }

    // Appends the bucket to the chunk.
    void finish(CellChunk& chunk);

private:
    static constexpr uint32_t no_point = 0xFFFFFFFFU;

    struct Cell {
        uint32_t slot;    // of the open group
        uint32_t header;  // of the open group, in words_
        uint32_t last;    // point, or one that no point equals
        uint32_t count;   // of words
    };
    struct CellWord {
        uint32_t cell;
        uint32_t word;
    };

    void begin_run(uint32_t cell, uint32_t slot, uint32_t flags, uint32_t from, const PatternWords& pattern);
    void open_group(uint32_t cell, uint32_t slot, uint32_t flags);
    // Room for the words of one call.
    void reserve_words();
    void add_word(uint32_t cell, uint32_t word) {
        words_[word_count_++] = {cell, word};
        ++cells_[cell].count;
    }

    int level_ = 0;
    std::vector<Cell> cells_;
    LargeArray<CellWord> words_;  // word_count_ of them
    size_t word_count_ = 0;
    std::vector<uint32_t> cursors_;
    uint64_t edges_ = 0;
};

}  // namespace decalgl

// A pyramid over blocks of the terrain: each level joins two by two blocks of the one below.
//
//     level 0   +-+-+-+-+-+      level 1   +---+---+-+      level 2   +-------+-+
//               | | | | | |                |   |   | |                |       | |
//               +-+-+-+-+-+                +---+---+-+                +-------+-+
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "decalgl/core/parallel.h"

namespace decalgl {

// Blocks of a level, the last ones too.
struct BlockBox {
    int32_t left;
    int32_t right;
    int32_t top;
    int32_t bottom;

    int32_t across() const { return std::max(right - left, bottom - top); }
    void halve() {
        left /= 2;
        right /= 2;
        top /= 2;
        bottom /= 2;
    }
};

// `Range` has a method add(const Range&); `nothing` is what adds nothing.
template <typename Range>
class Pyramid {
public:
    Pyramid() = default;
    // `range_of(row, column)` is a block of level 0, called on any thread.
    template <typename RangeFn>
    Pyramid(int32_t columns, int32_t rows, const Range& nothing, unsigned threads, const RangeFn& range_of)
        : nothing_(nothing) {
        Level base = level_of(columns, rows);
        parallel_for(base.blocks.size(), 4096, threads, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i)
                base.blocks[i] = range_of(static_cast<int32_t>(i / static_cast<size_t>(columns)),
                                          static_cast<int32_t>(i % static_cast<size_t>(columns)));
        });
        levels_.push_back(std::move(base));
        while (levels_.back().blocks.size() > 1)
            add_coarser();
    }

    static uint64_t bytes(int32_t columns, int32_t rows) {
        uint64_t blocks = 1;
        for (; columns > 1 || rows > 1; columns = (columns + 1) / 2, rows = (rows + 1) / 2)
            blocks += static_cast<uint64_t>(columns) * static_cast<uint64_t>(rows);
        return blocks * sizeof(Range);
    }

    int32_t columns() const { return levels_[0].columns; }
    int32_t rows() const { return levels_[0].rows; }
    const Range& all() const { return levels_.back().blocks[0]; }

    // Of blocks of level 0, from the finest level at which the last is at most so many from the first.
    Range over(BlockBox box, int32_t across) const {
        size_t level = 0;
        for (; box.across() > across && level + 1 < levels_.size(); ++level)
            box.halve();
        Range range = nothing_;
        for (int32_t row = box.top; row <= box.bottom; ++row)
            for (int32_t column = box.left; column <= box.right; ++column)
                range.add(levels_[level].at(row, column));
        return range;
    }

private:
    struct Level {
        int32_t columns;
        int32_t rows;
        std::vector<Range> blocks;

        Range& at(int32_t row, int32_t column) {
            return blocks[static_cast<size_t>(row) * static_cast<size_t>(columns) +
                          static_cast<size_t>(column)];
        }
        const Range& at(int32_t row, int32_t column) const {
            return const_cast<Level*>(this)->at(row, column);
        }
    };

    Level level_of(int32_t columns, int32_t rows) const {
        return {columns, rows,
                std::vector<Range>(static_cast<size_t>(columns) * static_cast<size_t>(rows), nothing_)};
    }

    void add_coarser() {
        const Level& finer = levels_.back();
        Level level = level_of((finer.columns + 1) / 2, (finer.rows + 1) / 2);
        for (int32_t row = 0; row < finer.rows; ++row)
            for (int32_t column = 0; column < finer.columns; ++column)
                level.at(row / 2, column / 2).add(finer.at(row, column));
        levels_.push_back(std::move(level));
    }

    Range nothing_{};
    std::vector<Level> levels_;
};

}  // namespace decalgl

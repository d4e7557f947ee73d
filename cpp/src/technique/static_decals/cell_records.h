// Cell records: the pieces of one run of features on their way into cells.
#pragma once

#include <cstdint>
#include <vector>

#include "decalgl/core/large_array.h"
#include "technique/static_decals/cell_grid.h"

namespace decalgl {

struct CellRecord {
    uint32_t cell;  // CellGrid::cell_index
    uint32_t slot;  // feature in draw order, topmost first
    uint16_t x0, y0, x1, y1;
};
static_assert(sizeof(CellRecord) == 16, "records are partitioned by the million");

// A record with this x0, which no piece has, marks cells that the feature covers (cell_stream.h): y0 of them, one row
// after another.
constexpr uint16_t covers_marker = HEADER_MARK;

class CellRecords {
  public:
    explicit CellRecords(const CellGrid& grid) : grid_(&grid), bucket_sizes_(grid.bucket_count(), 0) {}

    void set_slot(uint32_t slot) { slot_ = slot; }

    void add_piece(uint32_t cell, uint16_t x0, uint16_t y0, uint16_t x1, uint16_t y1) {
        records_.push_back({cell, slot_, x0, y0, x1, y1});
        ++bucket_sizes_[cell / BUCKET_CELLS];
    }

    // Marks rows first_row .. last_row of a column as covered.
    void add_covered(int32_t column, int32_t first_row, int32_t last_row) {
        const int32_t bucket_side = 1 << BUCKET_BITS;
        for (int32_t row = first_row; row <= last_row;) {
            const int32_t bucket_end = (row / bucket_side + 1) * bucket_side;
            const int32_t end = bucket_end < last_row + 1 ? bucket_end : last_row + 1;
            add_piece(grid_->cell_index(column, row), covers_marker, static_cast<uint16_t>(end - row), 0, 0);
            row = end;
        }
    }

    const CellGrid& grid() const { return *grid_; }
    const LargeArray<CellRecord>& records() const { return records_; }
    const std::vector<uint32_t>& bucket_sizes() const { return bucket_sizes_; }
    void reserve(size_t count) { records_.reserve(count); }
    void release() { LargeArray<CellRecord>().swap(records_); }

  private:
    const CellGrid* grid_;
    uint32_t slot_ = 0;
    LargeArray<CellRecord> records_;
    std::vector<uint32_t> bucket_sizes_;
};

}  // namespace decalgl

// Cell records: the pieces of one run of features on their way into cells.
#pragma once

#include <cstdint>
#include <vector>

#include "decalgl/core/large_array.h"
#include "decalgl/core/span.h"
#include "technique/static_decals/cell_grid.h"

namespace decalgl {

struct CellRecord {
    uint32_t cell;  // CellGrid::cell_index
    uint32_t slot;  // feature in draw order, topmost first
    uint16_t x0, y0, x1, y1;
};
static_assert(sizeof(CellRecord) == 16, "records are partitioned by the million");

// A record with this x0, which no piece has, marks cells that the feature covers (cell_stream.h): y0 of them,
// one row after another.
constexpr uint16_t covers_marker = HEADER_MARK;

class CellRecords {
public:
    explicit CellRecords(const CellGrid& grid) : grid_(&grid), bucket_starts_(grid.bucket_count() + 1, 0) {}

    void set_slot(uint32_t slot) { slot_ = slot; }

    void add_piece(uint32_t cell, uint16_t x0, uint16_t y0, uint16_t x1, uint16_t y1) {
        records_.push_back({cell, slot_, x0, y0, x1, y1});
        ++bucket_starts_[cell / BUCKET_CELLS];
    }

    // Marks rows first_row .. last_row of a column as covered.
    void add_covered(int32_t column, int32_t first_row, int32_t last_row);

    // Brings the records into buckets, keeping their order there. Nothing may be added afterwards.
    void sort_into_buckets();

    Span<const CellRecord> bucket(uint32_t index) const {
        return {records_.data() + bucket_starts_[index], bucket_starts_[index + 1] - bucket_starts_[index]};
    }

    const CellGrid& grid() const { return *grid_; }
    size_t size() const { return records_.size(); }
    void reserve(size_t count) { records_.reserve(count); }

private:
    const CellGrid* grid_;
    uint32_t slot_ = 0;
    LargeArray<CellRecord> records_;
    std::vector<uint32_t> bucket_starts_;  // counts, until sorted
};

}  // namespace decalgl

#include "technique/static_decals/cell_records.h"

namespace decalgl {

void CellRecords::add_covered(int32_t column, int32_t first_row, int32_t last_row) {
    constexpr int32_t bucket_side = 1 << BUCKET_BITS;
    for (int32_t row = first_row; row <= last_row;) {
        const int32_t bucket_end = (row / bucket_side + 1) * bucket_side;
        const int32_t end = bucket_end < last_row + 1 ? bucket_end : last_row + 1;
        add_piece(grid_->cell_index(column, row), covers_marker, static_cast<uint16_t>(end - row), 0, 0);
        row = end;
    }
}

void CellRecords::sort_into_buckets() {
    uint32_t start = 0;
    for (uint32_t& entry : bucket_starts_) {
        const uint32_t count = entry;
        entry = start;
        start += count;
    }
    std::vector<uint32_t> cursors(bucket_starts_.begin(), bucket_starts_.end() - 1);
    LargeArray<CellRecord> sorted;
    sorted.resize(records_.size());
    for (const CellRecord& record : records_)
        sorted[cursors[record.cell / BUCKET_CELLS]++] = record;
    records_.swap(sorted);
}

}  // namespace decalgl

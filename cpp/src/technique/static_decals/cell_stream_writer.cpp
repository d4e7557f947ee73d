#include "technique/static_decals/cell_stream_writer.h"

#include <array>
#include <limits>

#include "technique/static_decals/line_cells.h"

namespace decalgl {
namespace {

constexpr uint32_t no_slot = std::numeric_limits<uint32_t>::max();

// A cell while its groups are counted or written. A line that covers the cell needs none of its pieces.
struct OpenCell {
    uint32_t slot = no_slot;
    uint32_t header = 0;  // texels before the open group
    uint32_t end = 0;     // texels so far
    bool covered_by_line = false;
};

template <typename OnGroup, typename OnPiece, typename OnCovers>
void walk(Span<const CellRecord> records, Span<const DecalStyle> styles,
          std::array<OpenCell, BUCKET_CELLS>& cells, OnGroup on_group, OnPiece on_piece, OnCovers on_covers) {
    for (const CellRecord& record : records) {
        const bool is_line = styles[record.slot].half_width > 0.0F;
        const bool is_marker = record.x0 == covers_marker;
        const uint32_t first = record.cell % BUCKET_CELLS;
        const uint32_t count = is_marker ? record.y0 : 1;
        for (uint32_t index = first; index < first + count; ++index) {
            OpenCell& cell = cells[index];
            if (cell.slot != record.slot) {
                cell.slot = record.slot;
                cell.header = cell.end++;
                cell.covered_by_line = false;
                on_group(cell, record.slot, is_line);
            }
            if (cell.covered_by_line)
                continue;
            if (!is_marker) {
                on_piece(cell, record);
                ++cell.end;
                continue;
            }
            cell.covered_by_line = is_line;
            on_covers(cell);
        }
    }
}

}  // namespace

uint64_t count_bucket_texels(const std::vector<CellRecords>& runs, uint32_t bucket,
                             Span<const DecalStyle> styles, uint32_t* cell_texels) {
    std::array<OpenCell, BUCKET_CELLS> cells;
    const auto nothing = [](auto&&...) {};
    for (const CellRecords& run : runs)
        walk(run.bucket(bucket), styles, cells, nothing, nothing, nothing);
    uint64_t sum = 0;
    for (size_t i = 0; i < BUCKET_CELLS; ++i) {
        cell_texels[i] = cells[i].end;
        sum += cells[i].end;
    }
    return sum;
}

void write_bucket_texels(const std::vector<CellRecords>& runs, uint32_t bucket, Span<const DecalStyle> styles,
                         uint32_t start, uint32_t* cell_starts, CellTexel* texels) {
    std::array<OpenCell, BUCKET_CELLS> cells;
    for (size_t i = 0; i < BUCKET_CELLS; ++i) {
        const uint32_t count = cell_starts[i];
        cell_starts[i] = start;
        cells[i].end = start;
        start += count;
    }
    const auto on_group = [&](const OpenCell& cell, uint32_t slot, bool is_line) {
        const auto half_width = static_cast<double>(styles[slot].half_width);
        const uint32_t scale = is_line ? static_cast<uint32_t>(line_scale(half_width)) : 0;
        texels[cell.header] = {HEADER_MARK | scale << GROUP_SCALE_SHIFT | (is_line ? GROUP_LINE : 0), slot};
    };
    const auto on_piece = [&](const OpenCell& cell, const CellRecord& record) {
        texels[cell.end] = {record.x0 | static_cast<uint32_t>(record.y0) << 16,
                            record.x1 | static_cast<uint32_t>(record.y1) << 16};
    };
    const auto on_covers = [&](const OpenCell& cell) { texels[cell.header].x |= GROUP_COVERS; };
    for (const CellRecords& run : runs)
        walk(run.bucket(bucket), styles, cells, on_group, on_piece, on_covers);
}

}  // namespace decalgl

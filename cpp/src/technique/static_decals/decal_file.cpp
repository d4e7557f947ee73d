// Prepared static decals in an archive: the arrays as they are, and their scalars as one record.
//
// Opening reads every array once, on all cores, and refuses what would lead a walk through the cells out of
// them: query and the shaders believe their data.
#include <atomic>
#include <cmath>

#include "core/archive.h"
#include "decalgl/core/parallel.h"
#include "technique/static_decals/prepared_decals.h"

namespace decalgl {
namespace {

// Without padding, since its bytes go into the file.
struct DecalRecord {
    PositionGrid positions;
    double cell_size;
    double quantum;
    int64_t first_cell_x;
    int64_t first_cell_y;
    uint64_t segments;
    uint64_t pieces;
    int32_t columns;
    int32_t rows;
    int32_t bucket_columns;
    int32_t bucket_rows;
    uint32_t longest_cell;
    int32_t largest_scale;
    float widest;
    float narrowest;
    uint32_t has_polygons;
    uint32_t has_lines;
    uint32_t has_translucency;
    uint32_t unused;
};
static_assert(sizeof(DecalRecord) == 128, "saved as it is");

constexpr size_t block_items = 1 << 18;
constexpr int64_t farthest_cell = int64_t{1} << 31;
constexpr int largest_scale_there_is = GROUP_SCALE_MASK;

DecalRecord record_of(const PreparedDecals& decals) {
    const CellGrid& grid = decals.grid;
    return {grid.positions,
            grid.cell_size,
            grid.quantum,
            grid.first_cell_x,
            grid.first_cell_y,
            decals.segments,
            decals.pieces,
            grid.columns,
            grid.rows,
            grid.bucket_columns,
            grid.bucket_rows,
            decals.longest_cell,
            decals.largest_scale,
            decals.widest,
            decals.narrowest,
            decals.has_polygons,
            decals.has_lines,
            decals.has_translucency,
            0};
}

void restore(const DecalRecord& record, PreparedDecals& decals) {
    decals.grid = {record.positions,    record.cell_size,      record.quantum,
                   record.first_cell_x, record.first_cell_y,   record.columns,
                   record.rows,         record.bucket_columns, record.bucket_rows};
    decals.segments = record.segments;
    decals.pieces = record.pieces;
    decals.longest_cell = record.longest_cell;
    decals.largest_scale = record.largest_scale;
    decals.widest = record.widest;
    decals.narrowest = record.narrowest;
    decals.has_polygons = record.has_polygons != 0;
    decals.has_lines = record.has_lines != 0;
    decals.has_translucency = record.has_translucency != 0;
}

bool is_power_of_two(double value) {
    int exponent = 0;
    return std::isfinite(value) && std::frexp(value, &exponent) == 0.5;
}

bool is_grid(const CellGrid& grid, size_t start_count) {
    constexpr int32_t bucket_side = 1 << BUCKET_BITS;
    const auto buckets = [](int64_t cells) { return (cells + bucket_side - 1) / bucket_side; };
    const auto is_near = [](int64_t cell) { return -farthest_cell < cell && cell < farthest_cell; };
    if (grid.columns < 1 || grid.rows < 1 || grid.bucket_columns != buckets(grid.columns) ||
        grid.bucket_rows != buckets(grid.rows))
        return false;
    const uint64_t cells =
        static_cast<uint64_t>(grid.bucket_columns) * static_cast<uint64_t>(grid.bucket_rows) * BUCKET_CELLS;
    return start_count == cells + 1 && is_power_of_two(grid.cell_size) &&
           grid.quantum == grid.cell_size / CELL_QUANTA && is_near(grid.first_cell_x) &&
           is_near(grid.first_cell_y) && std::isfinite(grid.left()) && std::isfinite(grid.bottom());
}

// Whether a test that blocks of items pass holds for all of them.
template <typename HoldsFor>
bool all_blocks(size_t count, HoldsFor holds_for) {
    std::atomic<bool> all{true};
    parallel_for(count, block_items, 0, [&](size_t begin, size_t end) {
        if (all.load() && !holds_for(begin, end))
            all.store(false);
    });
    return all.load();
}

// Each cell's run begins with a header, where the one before has ended.
bool are_runs(const PreparedDecals& decals) {
    const SharedArray<uint32_t>& starts = decals.cell_starts;
    const SharedArray<CellTexel>& texels = decals.texels;
    if (starts[0] != 0 || starts[starts.size() - 1] != texels.size())
        return false;
    return all_blocks(starts.size() - 1, [&](size_t begin, size_t end) {
        for (size_t cell = begin; cell < end; ++cell) {
            const uint32_t first = starts[cell], last = starts[cell + 1];
            if (first > last || last > texels.size() || (first < last && !is_header(texels[first])))
                return false;
        }
        return true;
    });
}

bool name_slots(const PreparedDecals& decals) {
    const size_t slots = decals.slots.size();
    return all_blocks(decals.texels.size(), [&](size_t begin, size_t end) {
        bool all = true;  // without a way out, many texels are looked at together
        for (size_t i = begin; i < end; ++i)
            all &= !is_header(decals.texels[i]) | (decals.texels[i].y < slots);
        return all;
    });
}

}  // namespace

void PreparedDecals::save(ArchiveWriter& archive, const std::string& prefix) const {
    archive.add_value(prefix + "record", record_of(*this));
    archive.add(prefix + "cell starts", cell_starts.span());
    archive.add(prefix + "texels", texels.span());
    archive.add(prefix + "styles", styles.span());
    archive.add(prefix + "slots", slots.span());
}

std::unique_ptr<PreparedDecals> open_decals(const ArchiveReader& archive, const std::string& prefix) {
    auto decals = std::make_unique<PreparedDecals>();
    restore(archive.value<DecalRecord>(prefix + "record"), *decals);
    decals->cell_starts = archive.array<uint32_t>(prefix + "cell starts");
    decals->texels = archive.array<CellTexel>(prefix + "texels");
    decals->styles = archive.array<DecalStyle>(prefix + "styles");
    decals->slots = archive.array<FeatureReference>(prefix + "slots");
    const bool has_scale = decals->largest_scale >= 0 && decals->largest_scale <= largest_scale_there_is;
    if (!has_scale || !is_grid(decals->grid, decals->cell_starts.size()))
        archive.refuse("the grid of the static index makes no sense");
    if (decals->styles.size() != decals->slots.size() || !are_runs(*decals) || !name_slots(*decals))
        archive.refuse("the cells of the static index do not fit together");
    return decals;
}

}  // namespace decalgl

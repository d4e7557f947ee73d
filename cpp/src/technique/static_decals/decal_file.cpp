// Prepared static decals in an archive: the arrays as they are, and their scalars as one record.
//
// Opening reads every array once, on all cores, and refuses what would lead a walk through the cells out of
// them: query and the shaders believe their data.
#include <atomic>
#include <cmath>

#include "core/archive.h"
#include "decalgl/core/parallel.h"
#include "technique/draw_order.h"
#include "technique/static_decals/prepared_decals.h"

namespace decalgl {
namespace {

// Without padding, since its bytes go into the file.
struct DecalRecord {
    PositionGrid positions;
    double bucket_size;
    double quantum;
    int64_t first_bucket_x;
    int64_t first_bucket_y;
    uint64_t segments;
    uint64_t pieces;
    int32_t columns;
    int32_t rows;
    uint32_t longest_list;
    int32_t largest_scale;
    uint32_t has_polygons;
    uint32_t has_lines;
    uint32_t style_flags;
    uint32_t has_clips;
};
static_assert(sizeof(DecalRecord) == 112, "saved as it is");

constexpr size_t block_items = 1 << 18;
constexpr int64_t farthest_bucket = int64_t{1} << 31;
constexpr int largest_scale_there_is = 64;

DecalRecord record_of(const PreparedDecals& decals) {
    const BucketGrid& grid = decals.grid;
    return {grid.positions,      grid.bucket_size,    grid.quantum,         grid.first_bucket_x,
            grid.first_bucket_y, decals.segments,     decals.pieces,        grid.columns,
            grid.rows,           decals.longest_list, decals.largest_scale, decals.has_polygons,
            decals.has_lines,    decals.style_flags,  decals.has_clips};
}

void restore(const DecalRecord& record, PreparedDecals& decals) {
    decals.grid = {record.positions,      record.bucket_size, record.quantum, record.first_bucket_x,
                   record.first_bucket_y, record.columns,     record.rows};
    decals.segments = record.segments;
    decals.pieces = record.pieces;
    decals.longest_list = record.longest_list;
    decals.largest_scale = record.largest_scale;
    decals.has_polygons = record.has_polygons != 0;
    decals.has_lines = record.has_lines != 0;
    decals.style_flags = record.style_flags;
    decals.has_clips = record.has_clips != 0;
}

bool is_power_of_two(double value) {
    int exponent = 0;
    return std::isfinite(value) && std::frexp(value, &exponent) == 0.5;
}

bool is_grid(const BucketGrid& grid, size_t bucket_count) {
    const auto is_near = [](int64_t bucket) { return -farthest_bucket < bucket && bucket < farthest_bucket; };
    return grid.columns >= 1 && grid.rows >= 1 &&
           bucket_count == static_cast<uint64_t>(grid.columns) * static_cast<uint64_t>(grid.rows) &&
           is_power_of_two(grid.bucket_size) && grid.quantum == grid.bucket_size / BUCKET_QUANTA &&
           is_near(grid.first_bucket_x) && is_near(grid.first_bucket_y) && std::isfinite(grid.left()) &&
           std::isfinite(grid.bottom());
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

// Every bucket's cells and every cell's texels are there. A list that is too long for its count ends with the index at
// the latest.
bool are_lists(const PreparedDecals& decals) {
    const size_t cells = decals.cells.size(), texels = decals.words.size() / 4;
    const auto has_cells = [&](size_t begin, size_t end) {
        bool all = true;
        for (size_t i = begin; i < end; ++i) {
            const uint32_t level = decals.bucket_entries[i] & ((1U << LEVEL_BITS) - 1);
            all &= level == 0 || (COARSEST_LEVEL <= level && level <= FINEST_LEVEL);
            all &= (decals.bucket_entries[i] >> LEVEL_BITS) + (size_t{1} << (2 * level)) <= cells;
        }
        return all;
    };
    const auto has_texels = [&](size_t begin, size_t end) {
        bool all = true;
        for (size_t i = begin; i < end; ++i)
            all &= (decals.cells[i] >> COUNT_BITS) + size_t{decals.cells[i] & COUNT_ESCAPE} <= texels;
        return all;
    };
    return decals.words.size() % 4 == 0 && texels > 0 && decals.words[3] == LIST_END &&
           all_blocks(decals.bucket_entries.size(), has_cells) && all_blocks(cells, has_texels);
}

// Arrays of slots are as long as they are many.
bool are_of_slots(const PreparedDecals& decals) {
    const size_t count = decals.slots.size();
    const auto fits = [&](size_t size) { return size == 0 || size == count; };
    return count > 0 && decals.styles.size() == count && fits(decals.kinds.size()) &&
           fits(decals.ranks.size()) && permutes(decals.ranks, decals.ranks.size());
}

bool name_slots(const PreparedDecals& decals) {
    const size_t slots = decals.slots.size();
    return all_blocks(decals.words.size(), [&](size_t begin, size_t end) {
        bool all = true;  // without a way out, many words are looked at together
        for (size_t i = begin; i < end; ++i) {
            const uint32_t word = decals.words[i];
            all &= (word < HEADER) | (word == LIST_END) | ((word & SLOT_MASK) < slots);
        }
        return all;
    });
}

// Every slot's record lies within the table.
bool are_kinds(const PreparedDecals& decals) {
    if (decals.style_flags == 0 && !decals.has_clips)
        return decals.kinds.size() == 0;
    const size_t texels = decals.style_records.size();
    bool all = decals.kinds.size() == decals.slots.size() && texels > 0;
    for (size_t i = 0; all && i < decals.kinds.size(); ++i) {
        const size_t first = decals.kinds[i] >> SCALE_BITS;
        all = first < texels && first + style_record_size(decals.style_records[first]) <= texels;
    }
    return all;
}

}  // namespace

void PreparedDecals::save(ArchiveWriter& archive, const std::string& prefix) const {
    archive.add_value(prefix + "record", record_of(*this));
    archive.add(prefix + "buckets", bucket_entries.span());
    archive.add(prefix + "cells", cells.span());
    archive.add(prefix + "words", words.span());
    archive.add(prefix + "styles", styles.span());
    archive.add(prefix + "kinds", kinds.span());
    archive.add(prefix + "style_records", style_records.span());
    archive.add(prefix + "ranks", ranks.span());
    archive.add(prefix + "rules", rules.span());
    archive.add(prefix + "slots", slots.span());
}

std::unique_ptr<PreparedDecals> open_decals(const ArchiveReader& archive, const std::string& prefix) {
    auto decals = std::make_unique<PreparedDecals>();
    restore(archive.value<DecalRecord>(prefix + "record"), *decals);
    decals->bucket_entries = archive.array<uint32_t>(prefix + "buckets");
    decals->cells = archive.array<uint32_t>(prefix + "cells");
    decals->words = archive.array<uint32_t>(prefix + "words");
    decals->styles = archive.array<DecalStyle>(prefix + "styles");
    decals->slots = archive.array<Decal>(prefix + "slots");
    decals->kinds = archive.array<uint32_t>(prefix + "kinds");
    decals->style_records = archive.array<StyleTexel>(prefix + "style_records");
    decals->ranks = archive.array<uint32_t>(prefix + "ranks");
    decals->rules = archive.array<LayerRules>(prefix + "rules");
    const bool has_scale = decals->largest_scale >= 0 && decals->largest_scale <= largest_scale_there_is;
    if (!has_scale || !is_grid(decals->grid, decals->bucket_entries.size()))
        archive.refuse("the grid of the static index makes no sense");
    if (!are_of_slots(*decals) || !are_lists(*decals) || !name_slots(*decals))
        archive.refuse("the cells of the static index do not fit together");
    if (!are_kinds(*decals))
        archive.refuse("the styles of the static index do not fit together");
    decals->summarise_styles();
    return decals;
}

}  // namespace decalgl

// Prepared static decals: the grid, its cell lists and the features' styles, as flat arrays.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "decalgl/core/shared_array.h"
#include "decalgl/technique/technique.h"
#include "technique/static_decals/bucket_grid.h"
#include "technique/static_decals/style_table.h"

namespace decalgl {

// As the shaders read it, one a slot.
struct DecalStyle {
    std::array<uint8_t, 4> color;
    float half_width;  // quanta; 0 for polygons
};
static_assert(sizeof(DecalStyle) == 8, "read as one RG32UI texel");

class PreparedDecals : public Prepared {
public:
    PreparedCounts counts() const override;
    FeatureReference feature(uint32_t id) const override { return slots[id].feature; }
    std::vector<FeatureReference> query(double x, double y) const override;
    void save(ArchiveWriter& archive, const std::string& prefix) const override;

    // The words of a cell, to LIST_END or their end.
    Span<const uint32_t> list(uint32_t cell_entry) const;

    BucketGrid grid;
    // As cell_lists.h says.
    SharedArray<uint32_t> bucket_entries;
    SharedArray<uint32_t> cells;
    SharedArray<uint32_t> words;
    SharedArray<DecalStyle> styles;
    SharedArray<Decal> slots;     // topmost first
    SharedArray<uint32_t> kinds;  // of each slot, as style_records.h says; empty where all are plain
    SharedArray<StyleTexel> style_records;
    uint64_t segments = 0;
    uint64_t pieces = 0;
    uint32_t longest_list = 0;  // words
    int largest_scale = 0;
    float widest = 0.0F;  // half widths of lines, in quanta
    float narrowest = 0.0F;
    uint32_t style_flags = 0;  // of all style records
    bool has_clips = false;
    bool has_polygons = false;
    bool has_lines = false;
    bool has_one_color = true;
    bool has_translucency = false;
    MemoryCharge charge;  // of the arrays, but for those in a mapped file
};

// Throws Error(memory) where the index would not fit into the budget or what can be addressed, Error(cancelled).
std::unique_ptr<PreparedDecals> build_decals(const TechniqueInput& input, Progress& progress);

// What PreparedDecals::save wrote; the arrays stay in the file. Throws Error(file) where they do not fit
// together.
std::unique_ptr<PreparedDecals> open_decals(const ArchiveReader& archive, const std::string& prefix);

}  // namespace decalgl

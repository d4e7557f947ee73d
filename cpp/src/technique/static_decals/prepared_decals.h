// Prepared static decals: the grid, its cell lists and the features' styles, as flat arrays.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "core/growing_array.h"
#include "decalgl/core/shared_array.h"
#include "decalgl/technique/technique.h"
#include "technique/layer_rules.h"
#include "technique/layer_sources.h"
#include "technique/static_decals/bucket_grid.h"
#include "technique/static_decals/style_table.h"

namespace decalgl {

// As the shaders read it, one a slot.
struct DecalStyle {
    std::array<uint8_t, 4> color;
    float half_width;  // quanta; 0 for polygons
};
static_assert(sizeof(DecalStyle) == 8, "read as one RG32UI texel");

struct LookToken {};
struct ShapeToken {};

class PreparedDecals : public Prepared {
public:
    PreparedCounts counts() const override;
    FeatureReference feature(uint32_t id) const override { return slots[id].feature; }
    std::vector<FeatureReference> query(const SeenPoint& point) const override;
    void save(ArchiveWriter& archive, const std::string& prefix) const override;

    bool shows_anything() const override { return has_shown; }
    LayerLook look_of(uint32_t layer, size_t features) const override;
    std::shared_ptr<const Prepared> restyled(Span<const LayerLook> looks,
                                             const MemoryAccount& memory) const override;

    std::shared_ptr<const Prepared> with_sources(const TechniqueInput& input) const override;
    std::shared_ptr<const Prepared> edited(const LayerEdit& edit, const MemoryAccount& memory) const override;

    // Works out what styles have in common, from `widest` to `one_color`.
    void summarise_styles();
    // A line's words are in units of 2^scale quanta.
    int scale_of(uint32_t slot) const {
        return kinds.empty() ? line_scale(styles[slot].half_width)
                             : static_cast<int>(kinds[slot] & SCALE_MASK);
    }
    // Whether `kinds` tell shaders what half widths do not. Plain lines that may become wider are scaled for the widest:
    // where that takes no scale, none does.
    bool needs_kinds() const {
        return !kinds.empty() && (has_clips || style_records.size() > 1 || largest_scale > 0);
    }
    // Whether any width is corrected for slopes.
    bool has_slopes() const { return (style_flags & (STYLE_TANGENT | STYLE_THOENY)) != 0; }
    uint32_t rank_of(uint32_t slot) const { return ranks.empty() ? slot : ranks[slot]; }
    // The words of a cell, to LIST_END or their end.
    Span<const uint32_t> list(uint32_t cell_entry) const;

    BucketGrid grid;
    // As cell_lists.h says.
    SharedArray<uint32_t> bucket_entries;
    GrownArray<uint32_t> cells;
    GrownArray<uint32_t> words;
    SharedArray<DecalStyle> styles;
    SharedArray<uint32_t> kinds;  // of each slot, as style_records.h says; empty where all are plain
    SharedArray<StyleTexel> style_records;
    SharedArray<Decal> slots;       // as prepared, topmost first
    SharedArray<uint32_t> ranks;    // of each slot in draw order, topmost 0, where it is another; else empty
    SharedArray<LayerRules> rules;  // by the layer's place in the scene
    uint64_t segments = 0;
    uint64_t pieces = 0;
    uint32_t longest_list = 0;  // words
    int largest_scale = 0;
    uint32_t style_flags = 0;  // of all style records, and STYLE_WIDENED
    bool has_clips = false;
    float widest = 0.0F;  // half widths of lines, in quanta
    float narrowest = 0.0F;
    bool has_polygons = false;
    bool has_lines = false;
    bool has_one_color = true;  // of what is shown
    bool has_translucency = false;
    bool has_hidden = false;  // decals of alpha 0
    bool has_shown = false;   // any others
    std::array<uint8_t, 4> one_color{};
    // What edits need: null, and so refused, for an index that was opened from a file.
    std::shared_ptr<const LayerSources> sources;
    uint64_t unused_words = 0;  // of lists that edits have replaced
    // Where two indexes share it, buckets with the same entry look the same in both; or the same decals cover the same
    // points in both.
    std::shared_ptr<const LookToken> look_token = std::make_shared<const LookToken>();
    std::shared_ptr<const ShapeToken> shape_token = std::make_shared<const ShapeToken>();
};

// Throws Error(memory) where the index would not fit into the budget or what can be addressed, Error(cancelled).
std::unique_ptr<PreparedDecals> build_decals(const TechniqueInput& input, Progress& progress);

// What PreparedDecals::save wrote; the arrays stay in the file. Throws Error(file) where they do not fit
// together.
std::unique_ptr<PreparedDecals> open_decals(const ArchiveReader& archive, const std::string& prefix);

}  // namespace decalgl

// From the layers' styles to what builders and shaders need of each decal.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "decalgl/technique/technique.h"
#include "technique/static_decals/bucket_grid.h"
#include "technique/static_decals/style_records.h"

namespace decalgl {

using StyleTexel = std::array<uint32_t, 4>;

// Texels of a record, by its first one.
inline size_t style_record_size(const StyleTexel& first) {
    if ((first[0] & STYLE_HATCH) != 0)
        return 1 + size_t{2} * std::min(first[2], 2U);
    return 1 + (first[3] & COUNT_BITS_OF_MARKS) + (first[3] >> BANDS_SHIFT & COUNT_BITS_OF_MARKS);
}

// How a decal's geometry goes into cells. Lengths in quanta.
struct DecalShape {
    float half_width = 0.0F;  // the widest that it may become; of fills 0
    int8_t scale = 0;         // words are in units of 2^scale
    bool is_stroke = false;
    bool is_clip = false;
    bool is_clipped = false;  // by the slot before
    bool is_offset = false;   // of a clip: what is inside is cut off
    bool is_joined = false;
    bool covers_cells = true;  // whole cells may be said to be covered
    Corner corner = Corner::round;
    Cap cap = Cap::round;
    double miter_turn = 1.0;           // cosine of the largest turn that is mitred
    bool is_tangent = false;           // measured on slopes, where turns are others
    bool follows_ground = false;       // the pattern is measured along the ground
    double periods_per_quantum = 0.0;  // 0: no pattern
    double first_period = 0.0;         // where a line begins in its pattern

    // How far the stroke reaches from a vertex where its line turns by an angle of this cosine, at the most, and
    // from b between a and c.
    double reach_at_turn(double cosine) const;
    double longest_reach() const;
    double reach_near(LatticePoint a, LatticePoint b, LatticePoint c) const;
};

class StyleTable {
public:
    // Makes the records of all styles in the layers.
    StyleTable(const TechniqueInput& input, const BucketGrid& grid);

    DecalShape shape_of(const Decal& slot) const;
    // The first texel of the slot's record; 0 for a plain stroke or an even fill.
    uint32_t record_of(const Decal& slot) const;
    // The slot's entry in decal_kinds.
    uint32_t kind_of(const Decal& slot, const DecalShape& shape) const;
    DecalView view(const Decal& slot) const {
        return {&input_->layers[slot.feature.layer - input_->first_layer], slot};
    }

    const std::vector<StyleTexel>& texels() const { return texels_; }
    uint32_t flags() const { return flags_; }  // of all records

private:
    // First texels of the records of one layer's styles.
    struct LayerRecords {
        std::vector<uint32_t> strokes, casings, hatches;
    };

    std::vector<uint32_t> add_strokes(const Stroke& stroke);
    uint32_t add_stroke(const StrokeStyle& style);
    uint32_t add_hatch(const Hatch& hatch);

    const TechniqueInput* input_;
    const BucketGrid* grid_;
    std::vector<LayerRecords> layers_;
    std::vector<StyleTexel> texels_;
    uint32_t flags_ = 0;
};

// Decals bottom to top as slots, topmost first; a clip comes before each outline that lies on one side of its border.
std::vector<Decal> slots_of(const TechniqueInput& input);

}  // namespace decalgl

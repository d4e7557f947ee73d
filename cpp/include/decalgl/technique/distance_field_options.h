// What the technique "distance_field" lets its users choose: categories, their styles by level of detail, and how
// the fields are held. After Trapp et al. 2015.
//
//     S = (width, main, main colour, border colour)         width     metres across
//                                                           main      share of it in the main colour
//       border |     main     | border
//     ---------+--------------+---------  width
//
//     tuples   (lod 0, S) ... (lod 1, S): a pixel's level of detail lies between two of them
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "decalgl/core/span.h"
#include "decalgl/vector/layer.h"

namespace decalgl {

struct NetworkStyle {
    double lod = 0.0;
    double width = 0.0;
    double main = 1.0;
    std::array<float, 4> main_color{};  // sRGB, straight alpha, 0 to 1
    std::array<float, 4> border_color{};
    double texture_share = 0.0;  // of the category's raster in the main colour
};

// The border of a network drawn by an unsteady hand.
struct Sketch {
    double amplitude = 0.0;  // share of the half width; 0: a ruler's
    double length = 1.0;     // metres along the line between two turns
};

// How a line's end, or a node between segments, is drawn.
enum class CapShape : int { round = 1, square = 2, butt = 3 };
constexpr int first_custom_cap = 4;  // and further ones: a place in DistanceFieldOptions::drop_offs
constexpr int cap_grades = 4;        // ends, joints, junctions of three, of four and more

struct NetworkCategory {
    std::string name;
    std::vector<NetworkStyle> styles;              // by rising lod
    std::array<int, cap_grades> caps{1, 1, 1, 1};  // by the node's grade, at ends of lines
    SlopeCorrection slope_correction = SlopeCorrection::none;
    LinePattern pattern;
    int raster = -1;             // place in DistanceFieldOptions::rasters
    double raster_length = 1.0;  // metres along the line
    Sketch sketch;
};

// R, G, B, A, sRGB, straight alpha, row by row; columns go along the line, rows from its middle to its border.
struct NetworkRaster {
    int width = 0;
    int height = 0;
    std::vector<uint8_t> texels;
};

enum class LodSource : int { value, distance, texture };
// What a texture of levels of detail lies on: the map, the screen, or the ground before the camera.
enum class LodSpace : int { map, screen, camera };

struct LevelOfDetail {
    LodSource source = LodSource::value;
    double value = 0.0;
    double near = 0.0;  // metres of eye depth at which it is 0 and 1
    double far = 1.0;
    LodSpace space = LodSpace::map;
    // map: x, y of the lower left corner and the upper right one. camera: to the left and right of the view's
    // axis, and from the eye onwards, in metres.
    std::array<double, 4> extent{0.0, 0.0, 1.0, 1.0};
    int width = 0;  // of the texture; rows from bottom to top
    int height = 0;
    std::vector<uint8_t> texels;
};

enum class LodPlace { fragment, vertex };  // where widths take their level of detail from
enum class FieldBlending {
    minimum,
    nearest
};  // of overlapping segments: the least of each target, or one's own
enum class DropOff { texture, exact };
// Borders as they come, bottom-up; below the main colours of all categories; or flowing into each other.
enum class Borders { over, under, smooth };

struct DistanceFieldOptions : TechniqueOptions {
    std::vector<NetworkCategory> categories;  // bottom to top; empty: one for each look of the features
    std::vector<uint32_t> category_of;        // of each feature, or no_network_category; empty where they are
    LevelOfDetail lod;
    LodPlace widths_at = LodPlace::fragment;
    int bits = 8;  // of a texel of a field: 8 or 32
    DropOff drop_off = DropOff::texture;
    FieldBlending blending = FieldBlending::minimum;
    Borders borders = Borders::under;
    bool keep_depth = false;             // a target for each category's depth, as published
    bool mend_intrusion = false;         // lines are narrower where others of their category come near
    bool mend_protrusion = false;        // ends are cut at the border of the category that they meet
    std::vector<NetworkRaster> rasters;  // of one size
    std::vector<std::vector<uint8_t>> drop_offs;  // drop_off_side^2 texels each

    bool equals(const TechniqueOptions& other) const override { return this == &other; }
    void write(ChoiceBytes& choices) const override;
    bool names_widths() const override { return true; }  // or other ones, as soon as they are restyled
};

constexpr uint32_t no_network_category = 0xFFFFFFFFU;  // of features that are not drawn
constexpr int drop_off_side = 512;
constexpr size_t most_network_categories = 64;
constexpr size_t most_lod_styles = 16;

// Throws Error(style) or Error(input) that says what is wrong.
void validate(const DistanceFieldOptions& options);

}  // namespace decalgl

// How lines and fills look: the styles that features of a layer share, and what each has for itself.
//
//     corner   round    miter    bevel          cap   round  ( ===    butt   [===    square  [ ===
//
//     pattern  marks, repeated along the line by its length on the map, or as it is seen
//
//              0   begin      end          period
//              |     +---------+             |
//              |     |          \            |     a mark is a trapezoid: dashes, arrows, stipples
//              |     +---------+             |
//
//     bands    colours from the centre line outwards, each to a share of the half width
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace decalgl {

enum class Corner : uint8_t { round, miter, bevel };
enum class Cap : uint8_t { round, butt, square };

// How wide a stroke is on a slope: as wide as on the map plane; by Thöny 2018, section 3.3; or as wide on the
// slope itself.
enum class SlopeCorrection : uint8_t { none, thoeny, tangent };

// Of widths: lengths on the ground, or on the screen.
enum class WidthUnits : uint8_t { metres, pixels };

struct PatternMark {
    double begin = 0.0;  // from the period's beginning
    double end = 0.0;
    double begin_width = 1.0;  // share of the line's width
    double end_width = 1.0;
};

struct LinePattern {
    double period = 0.0;  // 0: no pattern
    double offset = 0.0;  // into the period where a line begins
    std::vector<PatternMark> marks;
    WidthUnits units =
        WidthUnits::metres;  // of all lengths; pixels: seen head-on, for widths on the screen alone
};

struct ColorBand {
    double reach = 1.0;  // share of the half width, rising from band to band up to 1
    std::array<uint8_t, 4> color{};
};

struct StrokeStyle {
    Corner corner = Corner::round;
    Cap cap = Cap::round;
    double miter_limit = 40.0;  // degrees between the two segments; sharper corners are round
    SlopeCorrection slope_correction = SlopeCorrection::none;
    LinePattern pattern;
    std::vector<ColorBand> bands;  // in place of the feature's colour, whose alpha they are multiplied by
};

constexpr size_t most_pattern_marks = 16;
constexpr size_t most_color_bands = 16;

bool operator==(const StrokeStyle& a, const StrokeStyle& b);
inline bool operator!=(const StrokeStyle& a, const StrokeStyle& b) {
    return !(a == b);
}

// What a width is kept between, at every depth: pixels, and metres as they are seen head-on.
struct WidthLimits {
    double least_px = 0.0;
    double most_px = std::numeric_limits<double>::infinity();
    double least_metres = 0.0;
    double most_metres = std::numeric_limits<double>::infinity();

    bool any() const;
};

bool operator==(const WidthLimits& a, const WidthLimits& b);

// The strokes of a layer's features.
struct Stroke {
    std::vector<uint8_t> colors;  // R, G, B, A, sRGB, straight alpha: one, one a feature, or none: no strokes
    std::vector<double> widths;   // in `units`: one, or one a feature; 0: no stroke
    WidthUnits units = WidthUnits::metres;
    WidthLimits limits;
    std::vector<double>
        margins;  // of each width, what the limits do not count: theirs is the rest; empty: none
    std::vector<StrokeStyle> styles = {StrokeStyle{}};
    std::vector<uint32_t> style_of;  // each feature's place in `styles`; empty: the first for all
    double widest = 0.0;             // what a stroke may be widened to without preparing anew

    bool empty() const { return colors.empty(); }
    // Whether its width follows the view: by its units, or by limits.
    bool follows_view() const { return units == WidthUnits::pixels || limits.any(); }
    const uint8_t* color(size_t feature) const { return &colors[colors.size() == 4 ? 0 : 4 * feature]; }
    double width(size_t feature) const { return widths[widths.size() == 1 ? 0 : feature]; }
    double margin(size_t feature) const { return margins.empty() ? 0.0 : margins[feature]; }
    size_t style(size_t feature) const { return style_of.empty() ? 0 : style_of[feature]; }
};

// Parallel lines in place of an even fill.
struct Hatch {
    double spacing = 0.0;  // metres between the lines' centres; 0: an even fill
    double width = 0.0;    // metres
    double angle = 45.0;   // degrees, counter-clockwise from east
    bool crossed = false;  // with a second set of lines at right angles
};

// The fills of a layer's polygons.
struct Fill {
    std::vector<uint8_t> colors;  // as those of strokes
    std::vector<Hatch> hatches = {Hatch{}};
    std::vector<uint32_t> hatch_of;  // each feature's place in `hatches`; empty: the first for all

    bool empty() const { return colors.empty(); }
    const uint8_t* color(size_t feature) const { return &colors[colors.size() == 4 ? 0 : 4 * feature]; }
    size_t hatch(size_t feature) const { return hatch_of.empty() ? 0 : hatch_of[feature]; }
};

// Throw Error(style) or Error(input) that names the layer, the feature and the cure.
void validate(const Stroke& stroke, size_t features, const std::string& layer_name);
void validate(const Fill& fill, size_t features, const std::string& layer_name);

}  // namespace decalgl

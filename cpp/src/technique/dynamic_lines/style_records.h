// How lines look, as records for the GPU (shaders/technique/dynamic_lines/line_styles.h).
#pragma once

#include <array>
#include <map>
#include <vector>

#include "decalgl/vector/decal.h"
#include "technique/dynamic_lines/line_lattice.h"
#include "technique/dynamic_lines/line_styles.h"

namespace decalgl {

using PatternTexel = std::array<float, 4>;

// The octave of lengths along lines that a whole terrain in 64 pixels needs: all others are above it.
int first_octave(const LineLattice& lattice);

// Makes records of decals, and the table of their patterns.
class StyleRecords {
public:
    explicit StyleRecords(const LineLattice& lattice);

    // From bottom to top: one, or one for each colour across the line, the outermost first.
    std::vector<LineStyle> of(const DecalView& view);
    std::vector<PatternTexel> patterns;

private:
    uint32_t pattern_of(const LinePattern& pattern);

    double longest_pixel_;                           // metres of a pixel in the first octave
    std::map<const LinePattern*, uint32_t> places_;  // of those that are in the table
};

// The metres that 2^32 in `arc` stand for; 0 without a pattern.
double arc_length(const LineStyle& style, Span<const PatternTexel> patterns);

// Another colour of the feature, and another width of its line.
void set_color(LineStyle& style, const uint8_t* color);
void set_width(LineStyle& style, double width);
double width_of(const LineStyle& style);

}  // namespace decalgl

// How lines look: one record a slot. Read by C++ and GLSL alike; three texels of uvec4 each.
//
//     width    of half the line: in pixels, or in metres seen head-on at the pixel's depth; then brought between the
//              limits, of which those in metres are taken head-on as well; then the margin is added, in the width's units
//     bands    colours across a line are slots that follow each other, the innermost on top: each leaves alone what those
//              above it cover, so that together they cover a pixel once
//
//     patterns texels of vec4, by the place that `pattern` says:
//              marks, offset as a share of the period, 1 where lengths are metres of ground, metres of 2^32 in `arc`;
//              then of each mark begin and end as shares of the period, and the shares of the width there
#ifndef DECALGL_LINE_STYLES_H
#define DECALGL_LINE_STYLES_H

#ifdef __cplusplus
#include <cstdint>
namespace decalgl {
using uint = uint32_t;
#endif

#define LINE_STYLE_TEXELS 3

// `kind`
#define CORNER_MASK 3u  // as decalgl/vector/stroke.h counts them
#define CAP_SHIFT 2u    // two bits
#define IN_METRES 16u   // else in pixels
#define HAS_LIMITS 32u  // else those are not looked at
#define BAND_SHIFT 6u   // four bits: the band's number from the middle outwards
#define BAND_MASK 15u
#define INSIDE_ONLY 1024u   // of a ring: only what lies inside its polygon, or
#define OUTSIDE_ONLY 2048u  // only what lies outside
#define IS_BAND 4096u
#define MITER_SHIFT 16u  // the miter limit in 1/256 degree

#define NO_PATTERN 0u

// Lengths along lines are counted in octaves: of a pattern in pixels, a pixel stands for 2^-octave metres. These are so many
// that there is one for every zoom: from the terrain in 64 pixels on.
#define PATTERN_OCTAVES 20

struct LineStyle {
    uint color;  // as it is shown: R, G, B, A bytes, straight alpha; alpha 0 is not drawn
    float half_width;
    uint kind;
    uint pattern;
    float least_px;  // limits of the half width
    float most_px;
    float least_metres;
    float most_metres;
    float margin;    // beyond the limits, of half the line
    float reach;     // of a band: the share of the half width that it goes to, else 1
    uint own_color;  // the feature's, before bands
    uint band_color;
};

#ifdef __cplusplus
static_assert(sizeof(LineStyle) == 16 * LINE_STYLE_TEXELS, "read as texels");
}  // namespace decalgl
#endif

#endif

// How lines look: one record a slot. Read by C++ and GLSL alike; two texels of uvec4 each.
//
//     width    of half the line: in pixels, or in metres seen head-on at the pixel's depth; then brought between the
//              limits, of which those in metres are taken head-on as well
#ifndef DECALGL_LINE_STYLES_H
#define DECALGL_LINE_STYLES_H

#ifdef __cplusplus
#include <cstdint>
namespace decalgl {
using uint = uint32_t;
#endif

#define LINE_STYLE_TEXELS 2

// `kind`
#define CORNER_MASK 3u   // as decalgl/vector/stroke.h counts them
#define CAP_SHIFT 2u     // two bits
#define IN_METRES 16u    // else in pixels
#define HAS_LIMITS 32u   // else those are not looked at
#define MITER_SHIFT 16u  // the miter limit in 1/256 degree

struct LineStyle {
    uint color;  // R, G, B, A bytes, straight alpha; alpha 0 is not drawn
    float half_width;
    uint kind;
    uint unused;
    float least_px;  // limits of the half width
    float most_px;
    float least_metres;
    float most_metres;
};

#ifdef __cplusplus
static_assert(sizeof(LineStyle) == 16 * LINE_STYLE_TEXELS, "read as texels");
}  // namespace decalgl
#endif

#endif

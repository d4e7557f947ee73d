// How lines look (line_styles.h).
//
// LIMITS   widths that depend on the depth
// STYLED   patterns along lines, and colours across
// LENS     other looks inside the lens
#include "technique/dynamic_lines/line_styles.h"

uniform usamplerBuffer line_styles;

#ifdef LENS
uniform int lens_styles;  // texels from the styles outside the lens to those inside

int first_style = 0;
#else
const int first_style = 0;
#endif

struct LineLook {
    vec4 color;  // straight alpha
    float half_width;
    uint kind;
    uint pattern;
    float reach;
};

LineLook no_look() {
    return LineLook(vec4(0.0), 0.0, 0u, NO_PATTERN, 1.0);
}

uvec4 style_texel(uint slot, int texel) {
    return texelFetch(line_styles, first_style + LINE_STYLE_TEXELS * int(slot) + texel);
}

LineLook look_of(uint slot) {
    uvec4 texel = style_texel(slot, 0);
    float reach = 1.0;
#ifdef STYLED
    reach = uintBitsToFloat(style_texel(slot, 2).y);
#endif
    return LineLook(unpackUnorm4x8(texel.r), uintBitsToFloat(texel.g), texel.b, texel.a, reach);
}

// Of the whole line in pixels, where a metre seen head-on takes so many.
float half_width_in_pixels(LineLook look, uint slot, float pixels_per_metre) {
    float width = look.half_width;
#ifdef LIMITS
    float unit = (look.kind & IN_METRES) != 0u ? pixels_per_metre : 1.0;
    vec4 limits = uintBitsToFloat(style_texel(slot, 1));
    float least = max(limits.x, limits.z * pixels_per_metre), most = min(limits.y, limits.w * pixels_per_metre);
    width = min(max(width * unit, least), most) + uintBitsToFloat(style_texel(slot, 2).x) * unit;
#endif
    return width;
}

uint corner_of(uint kind) {
    return kind & CORNER_MASK;
}

uint cap_of(uint kind) {
    return kind >> CAP_SHIFT & 3u;
}

float miter_limit(uint kind) {
    return radians(float(kind >> MITER_SHIFT) / 256.0);
}

// Whether it is drawn, or keeps others of its line off.
bool takes_room(LineLook look) {
    return look.color.a > 0.0 || (look.kind & IS_BAND) != 0u;
}

// How far corners and caps reach from the line's middle, in half widths: a miter's tip, a square cap's corner.
float joint_reach(uint kind) {
    return max(1.4143, corner_of(kind) == 1u ? 1.0 / sin(0.5 * miter_limit(kind)) : 1.0);
}

// Colours across a line are slots that follow each other: what they have in common is the slot of the innermost.
uint line_of(uint slot, uint kind) {
    return slot + (kind >> BAND_SHIFT & BAND_MASK);
}

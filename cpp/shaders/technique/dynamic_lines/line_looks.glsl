// How lines look (line_styles.h).
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
};

LineLook look_of(uint slot) {
    uvec4 texel = texelFetch(line_styles, first_style + LINE_STYLE_TEXELS * int(slot));
    return LineLook(unpackUnorm4x8(texel.r), uintBitsToFloat(texel.g), texel.b);
}

// In pixels, where a metre seen head-on takes so many.
float half_width_in_pixels(LineLook look, uint slot, float pixels_per_metre) {
    float width = look.half_width;
#ifdef LIMITS
    width *= (look.kind & IN_METRES) != 0u ? pixels_per_metre : 1.0;
    vec4 limits = uintBitsToFloat(texelFetch(line_styles, first_style + LINE_STYLE_TEXELS * int(slot) + 1));
    float least = max(limits.x, limits.z * pixels_per_metre), most = min(limits.y, limits.w * pixels_per_metre);
    width = min(max(width, least), most);
#endif
    return width;
}

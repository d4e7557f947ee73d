// How decals look: one record for each slot, and with a lens a second set of records for what is seen inside it.
//
//     decal_styles    slot 0 ... slot n - 1 | slot 0 ... slot n - 1
//                     outside                 inside, from lens_styles on
uniform usamplerBuffer decal_styles;  // colour bytes, half width in quanta

#ifdef LENS
uniform sampler2D lens_texture;  // the share of a pixel that is inside, and whether its centre is
uniform int lens_styles;

int first_style = 0;  // of the set that is looked through

int style_place(uint slot) {
    return first_style + int(slot);
}
#else
int style_place(uint slot) {
    return int(slot);
}
#endif

// Straight alpha.
vec4 color_of(uint slot) {
    return unpackUnorm4x8(texelFetch(decal_styles, style_place(slot)).r);
}

bool is_shown(uint slot) {
#ifdef HIDDEN
    return texelFetch(decal_styles, style_place(slot)).r >> 24 != 0u;
#else
    return true;
#endif
}

// Quanta.
float half_width_of(uint slot) {
    return uintBitsToFloat(texelFetch(decal_styles, style_place(slot)).g);
}

#ifdef ONE_WIDTH
uniform float line_scale;       // units per quantum
uniform float line_half_width;  // in units
#endif

// Units per quantum, and the half width in units, of a plain line.
#if defined(LINES) && !defined(STYLES)
vec2 stroke_of(uint header) {
#ifdef ONE_WIDTH
    return vec2(line_scale, line_half_width);
#else
    float half_width = half_width_of(header & SLOT_MASK);
    int exponent;
    frexp(half_width * (1.0 / float(MAX_RADIUS)), exponent);
    float scale = exp2(-float(max(exponent, 0)));
    return vec2(scale, half_width * scale);
#endif
}
#endif

// Pixels picked out of a picture, in a texture of their own: a block of 8 x 8 texels for each, one for each of the 64
// samples of its area (area_samples.h).
//
//     k = 0   k = 1   ...
//     s s s s s s s s
//     s s s s s s s s        sample s of a pixel lies at gathered_offsets[s]
//
// RAYS   blocks of 4 x 4 instead, one texel for each ray: what four samples lie on
// WHOLE  one texel for each pixel
#ifdef RAYS
const int gathered_side = 4;
#elif defined(WHOLE)
const int gathered_side = 1;
#else
const int gathered_side = 8;
#endif
const int gathered_samples = gathered_side * gathered_side;

uniform usamplerBuffer gathered_pixels;  // x | y << 16, in the rectangle that is drawn
uniform int gathered_columns;            // blocks in a row of the texture
uniform vec2 gathered_offsets[gathered_samples];

// Which of the pixels this texel belongs to. The last blocks may be none's.
ivec2 gathered_pixel() {
    ivec2 block = ivec2(gl_FragCoord.xy) / gathered_side;
    int index = min(block.y * gathered_columns + block.x, textureSize(gathered_pixels) - 1);
    uint place = texelFetch(gathered_pixels, index).r;
    return ivec2(place & 0xFFFFu, place >> 16);
}

vec2 gathered_offset() {
    ivec2 inside = ivec2(gl_FragCoord.xy) & (gathered_side - 1);
    return gathered_offsets[inside.y * gathered_side + inside.x];
}

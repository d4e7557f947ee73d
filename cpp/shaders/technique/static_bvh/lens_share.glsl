// How much of a pixel is seen through the lens.
uniform sampler2D lens_texture;  // the share of a pixel that is inside, and whether its centre is
uniform bool by_share;           // else by the centre

float lens_share(ivec2 pixel) {
    vec2 mask = texelFetch(lens_texture, pixel, 0).rg;
    return by_share ? mask.r : mask.g;
}

// The lens: pixels on one side of its border, where features look alike.
uniform sampler2D lens_texture;  // the share of a pixel that is inside; whether its centre is
uniform int lens_side;           // 1: inside

float share_of_side(ivec2 pixel) {
    vec2 lens = texelFetch(lens_texture, pixel, 0).rg;
#ifdef SAMPLES
    float inside = lens.r;
#else
    float inside = lens.g > 0.5 ? 1.0 : 0.0;
#endif
    return lens_side == 1 ? inside : 1.0 - inside;
}

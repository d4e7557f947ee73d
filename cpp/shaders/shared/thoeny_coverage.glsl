// The share of a pixel that a line covers, after Thöny et al. 2018, section 3.5.
//
// The line is taken to be parallel to a side of the pixel, and to have no ends:
//
//     coverage = clamp((min(p/2 - d, r) + min(p/2 + d, r)) / p, 0, 1)
//
// with the pixel's width p, the distance d of its centre from the line and the line's half width r. A line is so
// never thinner than a pixel, but fades with its share of it. The paper finds errors up to 0.09, at 45 degrees.

// How wide a pixel is in a direction of unit length; `foot`: the map's vectors for one pixel right and up.
float pixel_width(mat2 foot, vec2 direction) {
    return length(direction * foot);
}

float thoeny_coverage(float distance, float half_width, float pixel) {
    float half_pixel = 0.5 * pixel;
    float covered = min(half_pixel - distance, half_width) + min(half_pixel + distance, half_width);
    return clamp(covered / pixel, 0.0, 1.0);
}

// The same along the line: the share of a pixel at `phase` that a part of each period, from `begin` to `end`,
// takes up.
float thoeny_mark_coverage(float begin, float end, float period, float phase, float pixel) {
    vec2 ends = (phase + vec2(-0.5, 0.5) * pixel) / period;
    vec2 turns = floor(ends);
    vec2 reached = turns * (end - begin) + clamp((ends - turns) * period - begin, 0.0, end - begin);
    return clamp((reached.y - reached.x) / pixel, 0.0, 1.0);
}

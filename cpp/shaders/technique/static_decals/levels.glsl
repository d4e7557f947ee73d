// Levels of detail: the mean over a pixel that spans some texels of the finest level (levels.h).
//
// The pixel's parallelogram is covered by taps a texel apart, each a bilinear mean around it, on the level at which the
// pixel is FEWEST_TEXELS to twice as many texels wide.
uniform float texels_per_bucket;
uniform sampler2D levels;
#ifdef LENS
uniform sampler2D lens_levels;
#endif

const float most_texels_along = 24.0;  // of a pixel's longer side

// A pixel's sides in texels of the finest level.
vec2 sides_in_texels(mat2 foot) {
    return vec2(length(foot[0]), length(foot[1])) * (texels_per_bucket / float(BUCKET_QUANTA));
}

bool spans_texels(mat2 foot) {
    vec2 sides = sides_in_texels(foot);
    return min(sides.x, sides.y) >= float(FEWEST_TEXELS);
}

vec4 level_at(vec2 place, float level) {
#ifdef LENS
    if (first_style != 0) return textureLod(lens_levels, place, level);
#endif
    return textureLod(levels, place, level);
}

vec4 mean_of_levels(LatticePosition centre, mat2 foot) {
    vec2 sides = sides_in_texels(foot);
    float wanted = max(min(sides.x, sides.y) / float(FEWEST_TEXELS), max(sides.x, sides.y) / most_texels_along);
    float level = max(floor(log2(wanted)), 0.0);
    ivec2 taps = max(ivec2(ceil(sides * exp2(-level))), ivec2(1));
    vec2 per_quantum = texels_per_bucket / float(BUCKET_QUANTA) / vec2(textureSize(levels, 0));
    vec2 at = (vec2(centre.quantum) + centre.fraction) * per_quantum;
    vec4 sum = vec4(0.0);
    int tap = 0;
    do {
        vec2 place = (vec2(tap % taps.x, tap / taps.x) + 0.5) / vec2(taps) - 0.5;
        sum += level_at(at + foot * place * per_quantum, level);
    } while (++tap < taps.x * taps.y);
    return sum / float(taps.x * taps.y);
}

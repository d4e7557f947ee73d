// Levels of detail: the mean over a pixel that spans some texels of the finest level (levels.h).
//
// The pixel's parallelogram is covered by taps, each a bilinear mean around it, on the level at which the pixel is
// FEWEST_TEXELS to twice as many texels wide.
uniform sampler2D levels;
#ifdef LENS
uniform sampler2D lens_levels;
#endif

const float most_taps = 12.0;  // along a pixel's longer side
const float texels_per_tap = 1.5;
const float texels_per_fine_tap = 1.0;
const float most_tap_spread = 0.02;

// A pixel's sides in texels of the finest level.
vec2 sides_in_texels(mat2 foot) {
    return vec2(length(foot[0]), length(foot[1])) * (float(LEVEL_TEXELS) / float(BUCKET_QUANTA));
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

// A level's mean over a pixel. It is rough where the taps tell what lies at its border too coarsely.
vec4 mean_of_level(LatticePosition centre, mat2 foot, float level, float per_tap, out bool is_rough) {
    vec2 sides = sides_in_texels(foot);
    ivec2 taps = ivec2(clamp(ceil(sides * exp2(-level) / per_tap), vec2(1.0), vec2(4.0 * most_taps)));
    vec2 per_quantum = float(LEVEL_TEXELS) / float(BUCKET_QUANTA) / vec2(textureSize(levels, 0));
    vec2 at = (vec2(centre.quantum) + centre.fraction) * per_quantum;
    vec4 sum = vec4(0.0), squares = vec4(0.0);
    int tap = 0;
    do {
        vec2 place = (vec2(tap % taps.x, tap / taps.x) + 0.5) / vec2(taps) - 0.5;
        vec4 color = level_at(at + foot * place * per_quantum, level);
        sum += color;
        squares += color * color;
    } while (++tap < taps.x * taps.y);
    sum /= float(taps.x * taps.y);
    vec4 spread = squares / float(taps.x * taps.y) - sum * sum;
    is_rough = any(greaterThan(spread, vec4(most_tap_spread * most_tap_spread)));
    return sum;
}

float level_of(mat2 foot) {
    vec2 sides = sides_in_texels(foot);
    float wanted = max(min(sides.x, sides.y) / float(FEWEST_TEXELS), max(sides.x, sides.y) / most_taps);
    return max(floor(log2(wanted)), 0.0);
}

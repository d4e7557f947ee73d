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
const float most_spread_per_texel = 0.02;

vec4 level_at(vec2 place, float level) {
#ifdef LENS
    if (first_style != 0) return textureLod(lens_levels, place, level);
#endif
    return textureLod(levels, place, level);
}

// `is_seen`: whether the pixel spans enough texels, and they tell enough of it. The finest level has few samples a texel:
// strokes that lie alone are shared out among them (thin_stroke.h), but which are seen of those that lie over each other is
// chance, all the more the more there are, and less over more texels.
vec4 mean_of_levels(LatticePosition centre, mat2 foot, out bool is_seen) {
    float texels_per_quantum = texels_per_bucket / float(BUCKET_QUANTA);
    vec2 sides = vec2(length(foot[0]), length(foot[1])) * texels_per_quantum;
    float across = min(sides.x, sides.y), along = max(sides.x, sides.y);
    is_seen = across >= float(FEWEST_TEXELS);
    if (!is_seen) foot = mat2(0.0);
    float level = max(floor(log2(max(across / float(FEWEST_TEXELS), along / most_texels_along))), 0.0);
    ivec2 taps = is_seen ? max(ivec2(ceil(sides * exp2(-level))), ivec2(1)) : ivec2(1);
    vec2 per_quantum = texels_per_quantum / vec2(textureSize(levels, 0));
    vec2 at = (vec2(centre.quantum) + centre.fraction) * per_quantum;
    vec4 sum = vec4(0.0), squares = vec4(0.0);
    int tap = 0;
    do {
        vec2 place = (vec2(tap % taps.x, tap / taps.x) + 0.5) / vec2(taps) - 0.5;
        vec4 color = level_at(at + foot * place * per_quantum, level);
        sum += color;
        squares += color * color;
    } while (++tap < taps.x * taps.y);
    vec4 mean = sum / float(taps.x * taps.y);
#ifdef LINES
    vec4 spread = squares / float(taps.x * taps.y) - mean * mean;
    float most_spread = most_spread_per_texel * across;
    if (level == 0.0 && any(greaterThan(mean.a * spread, vec4(most_spread * most_spread)))) is_seen = false;
#endif
    return mean;
}

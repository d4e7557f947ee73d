// The virtual texture at each pixel: samples along the footprint's longer side, each between two levels of detail.
//
// GATHERED   texels are samples of pixels from anywhere in the picture     LENS   one side of the lens's border
#include "technique/clipmap/place.glsl"
#ifdef GATHERED
#include "shared/gathered.glsl"
#endif

layout(location = 0) out vec4 color;

uniform sampler2DArray tiles;
uniform usampler2D table;  // x + 1, y + 1 of the tile that may be read in each slot
uniform int window;        // tiles, a power of two
#ifdef LENS
uniform sampler2D lens_texture;  // the share of a pixel that is inside
uniform int lens_side;           // 1: inside
#endif

bool is_there(ivec2 texel, int level) {
    ivec2 tile = texel >> tile_bits;
    ivec2 slot = tile & (window - 1);
    uvec2 found = texelFetch(table, ivec2(slot.x, level * window + slot.y), 0).xy;
    return found == uvec2(tile + 1);
}

// Colour at a place of the finest level, from the level of detail asked for or the next one that is there.
vec4 color_at(ivec2 texel, vec2 fraction, int detail) {
    int level = finest_level - detail;
    ivec2 low = texel;
    ivec2 high = texel;
    vec2 rest = fraction;
    bool found = false;
    do {
        int shift = finest_level - level;
        ivec2 own = texel >> shift;
        rest = (vec2(texel & ((1 << shift) - 1)) + fraction) / float(1 << shift);
        // The four texels that linear filtering reads. Those of the sampler would lie beyond what is there, by its rounding.
        ivec2 limit = ivec2((1 << (level + tile_bits)) - 1);
        ivec2 first = own + ivec2(floor(rest - 0.5));
        low = clamp(first, ivec2(0), limit);
        high = clamp(first + 1, ivec2(0), limit);
        found = level == 0 || (is_there(low, level) && is_there(high, level) &&
                               is_there(ivec2(low.x, high.y), level) && is_there(ivec2(high.x, low.y), level));
        level = found ? level : level - 1;
    } while (!found);
    int mask = (window << tile_bits) - 1;
    vec2 share = fract(rest - 0.5);
    vec4 below = mix(texelFetch(tiles, ivec3(low & mask, level), 0),
                     texelFetch(tiles, ivec3(high.x & mask, low.y & mask, level), 0), share.x);
    vec4 above = mix(texelFetch(tiles, ivec3(low.x & mask, high.y & mask, level), 0),
                     texelFetch(tiles, ivec3(high & mask, level), 0), share.x);
    return mix(below, above, share.y);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    Position position = unpack_position(texelFetch(position_texture, pixel, 0));
    vec4 surface = texelFetch(surface_texture, pixel, 0);
    if (is_sky(position)) {
        color = vec4(0.0);
        return;
    }
#ifdef GATHERED
    // Where the sample lies, so that its footprint is that of its own ray on its own plane.
    vec2 seen = vec2(gathered_pixel()) + 0.5 + vec2(picture.xy) - 0.5 * spacing.zw + gathered_offset();
    Place place = place_of(position, surface, seen);
#else
    Place place = place_of(position, surface, pixel_from_centre());
#endif
    int detail = int(floor(place.level));
    float coarser = place.level - float(detail);
    vec4 sum = vec4(0.0);
    float tap = 0.0;
    do {
        vec2 at = place.fraction + ((tap + 0.5) / place.taps - 0.5) * place.along;
        ivec2 texel = place.texel + ivec2(floor(at));
        vec2 fraction = fract(at);
        vec4 fine = color_at(texel, fraction, detail);
        vec4 coarse = coarser > 0.0 ? color_at(texel, fraction, min(detail + 1, finest_level)) : fine;
        sum += mix(fine, coarse, coarser);
        tap += 1.0;
    } while (tap < place.taps);
    color = sum / place.taps;
#ifdef LENS
    float inside = texelFetch(lens_texture, pixel, 0).x;
    color *= lens_side == 1 ? inside : 1.0 - inside;
#endif
}

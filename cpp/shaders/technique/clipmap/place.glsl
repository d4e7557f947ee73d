// Where on the virtual texture a pixel lies, and how much of it the pixel takes in.
//
// A place is a texel of the finest level, as an integer, and a fraction: virtual_texture.h.
#include "shared/position.glsl"
#include "shared/ray.glsl"

const int finest_level = 12;
const int tile_bits = 8;

uniform usampler2D position_texture;
uniform sampler2D surface_texture;
uniform ivec2 first_block;
uniform int texels_per_block;
uniform float texels_per_metre;
uniform float anisotropy;

struct Place {
    ivec2 texel;
    vec2 fraction;
    vec2 along;  // the footprint's longer side, in texels of the finest level
    float taps;  // along it
    float level;  // of detail, from 0, the finest
};

// `from_centre`: the pixel, from the picture's centre.
Place place_of(Position position, vec4 surface, vec2 from_centre) {
    vec2 texels = position.offset * texels_per_metre;
    mat2 sides = footprint(from_centre, surface.xy, surface.z) * texels_per_metre;
    bool is_first = dot(sides[0], sides[0]) > dot(sides[1], sides[1]);
    vec2 along = is_first ? sides[0] : sides[1];
    float longer = length(along);
    // The width across the longer side, not the other side's length: that one may be nearly along it.
    float area = abs(sides[0].x * sides[1].y - sides[0].y * sides[1].x);
    float taps = clamp(ceil(longer * longer / max(area, 1e-20)), 1.0, anisotropy);
    return Place((position.block - first_block) * texels_per_block + ivec2(floor(texels)), fract(texels), along, taps,
                 clamp(log2(max(longer / taps, 1e-20)), 0.0, float(finest_level)));
}

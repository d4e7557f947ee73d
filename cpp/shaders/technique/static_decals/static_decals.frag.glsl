// Static decals, seen through one point a pixel or through 32 samples of its area.
//
// LINES, RINGS   the kinds of feature there are
// ONE_WIDTH      all lines are of one width: no need to look theirs up
// ONE_COLOR      all features are opaque and of one colour
// TRANSLUCENT    some feature is not opaque
// COVERAGE       the samples' mean, else the pixel's centre alone
// LEVELS         where it is many cells wide, from levels of detail
// STYLES         some decal is more than a plain stroke or an even fill: of what it can be, JOINED, PATTERNS, BANDS,
//                HATCHES, SLOPES
// IDS            writes 1 + slot of the topmost feature at the centre instead of a colour
#if !defined(STYLES) && (defined(JOINED) || defined(PATTERNS) || defined(BANDS) || defined(HATCHES) || defined(SLOPES))
#define STYLES
#endif
#include "shared/ray.glsl"
#include "technique/static_decals/point.glsl"
#include "technique/static_decals/area.glsl"

uniform usampler2D position_texture;
#if defined(COVERAGE) || defined(SLOPES)
uniform sampler2D surface_texture;
#endif

#ifdef IDS
layout(location = 0) out uint id;
#else
layout(location = 0) out vec4 color;
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    Position seen = unpack_position(texelFetch(position_texture, pixel, 0));
    LatticePosition position = on_lattice(seen);
#ifdef SLOPES
    set_slope(texelFetch(surface_texture, pixel, 0).xy);
#endif
#ifdef IDS
    id = walk_at(position).found + 1u;  // no slot, plus one, is 0
#elif defined(COVERAGE)
    vec4 surface = texelFetch(surface_texture, pixel, 0);
    // Sky has no surface: a pixel of no size, outside every grid, is done with at once.
    mat2 foot = is_sky(seen) ? mat2(0.0) : footprint(pixel_from_centre(), surface.xy, surface.z);
    color = composite_area(position, foot * quanta_per_metre);
#else
    color = color_at(position);
#endif
}

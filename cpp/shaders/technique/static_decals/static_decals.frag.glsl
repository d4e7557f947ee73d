// Static decals, seen through one point a pixel or through 32 samples of its area.
//
// LINES, RINGS   the kinds of feature there are
// ONE_WIDTH      all lines are of one width: no need to look theirs up
// TRANSLUCENT    some feature is not opaque
// COVERAGE       the samples' mean, else the pixel's centre alone
// IDS            writes 1 + slot of the topmost feature at the centre instead of a colour
#include "shared/ray.glsl"
#include "technique/static_decals/cells.glsl"
#if defined(COVERAGE) && !defined(IDS)
#include "technique/static_decals/area.glsl"
#else
#include "technique/static_decals/point.glsl"
#endif

uniform usampler2D position_texture;
#ifdef COVERAGE
uniform sampler2D surface_texture;
#endif

#ifdef IDS
layout(location = 0) out uint id;

uint topmost(CellPosition position) {
    Walk walk = begin_walk(position.cell);
    uint slot;
    return next_feature(walk, position.local, slot) ? slot + 1u : 0u;
}
#else
layout(location = 0) out vec4 color;
#endif

#if !defined(IDS) && !defined(COVERAGE)
// Front to back, until nothing behind can show.
vec4 composite(CellPosition position) {
    Walk walk = begin_walk(position.cell);
    vec4 sum = vec4(0.0);
    uint slot;
    while (sum.a < 0.999 && next_feature(walk, position.local, slot)) {
        vec4 straight = color_of(slot);
        sum += (1.0 - sum.a) * vec4(straight.rgb * straight.a, straight.a);
    }
    return sum;
}
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    Position position = unpack_position(texelFetch(position_texture, pixel, 0));
#ifdef IDS
    id = is_sky(position) ? 0u : topmost(locate(position));
#else
    color = vec4(0.0);
    if (is_sky(position)) return;
#ifdef COVERAGE
    vec4 surface = texelFetch(surface_texture, pixel, 0);
    mat2 foot = footprint(pixel_from_centre(), surface.xy, surface.z);
    color = composite_area(locate(position), foot * quanta_per_metre);
#else
    color = composite(locate(position));
#endif
#endif
}

// Static decals, seen through one point a pixel or through 32 samples of its area.
//
// LINES, RINGS   the kinds of feature there are
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
    uvec2 range = cell_range(position.cell);
    Group group;
    group.count = 0u;
    bool covered = false;
    uint found = 0u;
    for (uint at = range.x; at < range.y;) {
        if (step_walk(at, group, covered, position.local) && covered) {
            found = group.slot + 1u;
            at = range.y;
        }
    }
    return found;
}
#else
layout(location = 0) out vec4 color;
#endif

#if !defined(IDS) && !defined(COVERAGE)
// Front to back, until nothing behind can show.
vec4 composite(CellPosition position) {
    uvec2 range = cell_range(position.cell);
    Group group;
    group.count = 0u;
    bool covered = false;
    vec4 sum = vec4(0.0);
    for (uint at = range.x; at < range.y;) {
        if (step_walk(at, group, covered, position.local) && covered) {
            sum += (1.0 - sum.a) * vec4(group.color.rgb * group.color.a, group.color.a);
            if (sum.a >= 0.999) at = range.y;
        }
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

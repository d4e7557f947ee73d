// Static decals, seen through one point a pixel or through 32 samples of its area.
//
// LINES, RINGS   the kinds of feature there are
// ONE_WIDTH      all lines are of one width: no need to look theirs up
// ONE_COLOR      all features are opaque and of one colour
// TRANSLUCENT    some feature is not opaque
// COVERAGE       the samples' mean, else the pixel's centre alone
// LEVELS         where it is many cells wide, from levels of detail
// KINDS          strokes may be wider or narrower than they were prepared
// HIDDEN         some feature is not shown, and no colour is translucent
// LENS           some pixels are seen through the lens, where features look otherwise
// IDS            writes 1 + slot of the topmost feature at the centre instead of a colour
#include "shared/ray.glsl"
#include "technique/static_decals/point.glsl"
#include "technique/static_decals/area.glsl"

uniform usampler2D position_texture;
#ifdef COVERAGE
uniform sampler2D surface_texture;
#endif

#ifdef IDS
layout(location = 0) out uint id;
#else
layout(location = 0) out vec4 color;
#endif

#ifndef IDS
// Premultiplied.
vec4 seen_color(LatticePosition position, mat2 foot) {
#ifdef COVERAGE
    return composite_area(position, foot);
#else
    return color_at(position);
#endif
}
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    Position seen = unpack_position(texelFetch(position_texture, pixel, 0));
    LatticePosition position = on_lattice(seen);
#ifdef LENS
    vec2 lens = texelFetch(lens_texture, pixel, 0).rg;
#endif
#ifdef IDS
#ifdef LENS
    first_style = lens.g > 0.5 ? lens_styles : 0;
#endif
    id = walk_at(position).found + 1u;  // no slot, plus one, is 0
#else
    mat2 foot = mat2(0.0);
#ifdef COVERAGE
    vec4 surface = texelFetch(surface_texture, pixel, 0);
    // Sky has no surface: a pixel of no size, outside every grid, is done with at once.
    if (!is_sky(seen)) foot = footprint(pixel_from_centre(), surface.xy, surface.z) * quanta_per_metre;
#endif
#ifdef LENS
    // Outside, inside, or a share of both.
#ifdef COVERAGE
    float inside = lens.r;
#else
    float inside = lens.g;
#endif
    color = vec4(0.0);
    bool within = inside > 0.0;
    bool both = within && inside < 1.0;
    bool again;
    do {
        first_style = within ? lens_styles : 0;
        color += (within ? inside : 1.0 - inside) * seen_color(position, foot);
        again = both && within;
        within = false;
    } while (again);
#else
    color = seen_color(position, foot);
#endif
#endif
}

// Static decals, seen through one point a pixel or through 64 samples of its area.
//
// LINES, RINGS   the kinds of feature there are
// ONE_WIDTH      all lines are of one width: no need to look theirs up
// ONE_COLOR      all features are opaque and of one colour
// TRANSLUCENT    some feature is not opaque
// CLASSES        of a picture filtered over the pixels' areas, the first pass: classes of pixels, and those without borders
// CELLS, POINTS  the passes of the other classes (area_classes.h); else the pixels' centres are seen
// LEVELS         of CLASSES: levels of detail are there
// THOENY         of CELLS, in place of samples: strokes by their estimated coverage
// STYLES         some decal is more than a plain stroke or an even fill: of what it can be, JOINED, PATTERNS, BANDS,
//                HATCHES, SLOPES
// HIDDEN         some feature is not shown, and no colour is translucent
// LENS           some pixels are seen through the lens, where features look otherwise; there, LENS_LISTS: they lie in
//                another order, LENS_KINDS: they have other styles
// IDS            writes 1 + slot of the topmost feature at the centre instead of a colour
#ifndef LENS
#undef LENS_LISTS
#undef LENS_KINDS
#endif
#if !defined(STYLES) && (defined(THOENY) || defined(JOINED) || defined(PATTERNS) || defined(BANDS) || defined(HATCHES) || defined(SLOPES))
#define STYLES
#endif
#include "shared/ray.glsl"
#if defined(CLASSES) || defined(CELLS) || defined(THOENY) || defined(POINTS)
#define AREA
#endif
#include "technique/static_decals/point.glsl"
#ifdef AREA
#include "technique/static_decals/classes.glsl"
#ifdef THOENY
#include "technique/static_decals/thoeny.glsl"
#endif
#endif

uniform usampler2D position_texture;
#if defined(AREA) || defined(SLOPES)
uniform sampler2D surface_texture;
#endif

#ifdef IDS
layout(location = 0) out uint id;
#else
layout(location = 0) out vec4 color;
#if defined(AREA) && !defined(CLASSES)
layout(early_fragment_tests) in;
#endif
#endif

#ifndef IDS
// Premultiplied. `kind`: the lowest class that was found.
vec4 seen_color(LatticePosition position, mat2 foot, inout float kind) {
#if defined(CLASSES)
    Classed result = classed(position, foot);
    kind = min(kind, result.kind);
    return result.color;
#elif defined(THOENY)
    return composite_thoeny(position, foot);
#elif defined(POINTS)
    return composite_points(position, foot);
#elif defined(CELLS)
    return composite_area(position, foot);
#else
    return color_at(position);
#endif
}

#ifdef LENS
// What is seen outside the lens, inside, or a share of both.
vec4 color_through_lens(LatticePosition position, mat2 foot, inout float kind, float inside) {
    vec4 sum = vec4(0.0);
    bool within = inside > 0.0;
    bool both = within && inside < 1.0;
    bool again;
    do {
        first_style = within ? lens_styles : 0;
        sum += (within ? inside : 1.0 - inside) * seen_color(position, foot, kind);
        again = both && within;
        within = false;
    } while (again);
    return sum;
}
#endif
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    Position seen = unpack_position(texelFetch(position_texture, pixel, 0));
    LatticePosition position = on_lattice(seen);
#ifdef SLOPES
    set_slope(texelFetch(surface_texture, pixel, 0).xy);
#endif
#ifdef LENS
    vec2 lens = texelFetch(lens_texture, pixel, 0).rg;
#endif
#ifdef IDS
#ifdef LENS
    first_style = lens.g > 0.5 ? lens_styles : 0;
#endif
    id = walk_at(position).found + 1u;  // no slot, plus one, is 0
#else
    float kind = 1.0;
    mat2 foot = mat2(0.0);
#ifdef AREA
    vec4 surface = texelFetch(surface_texture, pixel, 0);
    // Sky has no surface: a pixel of no size, outside every grid, is done with at once.
    if (!is_sky(seen)) foot = footprint(pixel_from_centre(), surface.xy, surface.z) * quanta_per_metre;
#endif
#if defined(LENS) && defined(AREA)
    color = color_through_lens(position, foot, kind, lens.r);
#elif defined(LENS)
    color = color_through_lens(position, foot, kind, lens.g);
#else
    color = seen_color(position, foot, kind);
#endif
#ifdef CLASSES
    gl_FragDepth = kind;
#endif
#endif
}

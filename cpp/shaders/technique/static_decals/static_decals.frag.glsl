// Static decals, seen through one point a pixel or through 32 samples of its area.
//
// LINES, RINGS   the kinds of feature there are
// ONE_WIDTH      all lines are of one width: no need to look theirs up
// ONE_COLOR      all features are opaque and of one colour
// TRANSLUCENT    some feature is not opaque
// CLASSES        of a picture filtered over the pixels' areas, the first pass: classes of pixels, and those without borders
// CELLS, POINTS, FROM_LEVELS   the passes of the other classes (area_classes.h); else the pixels' centres are seen
// LEVELS         levels of detail are there
// STYLES         some decal is more than a plain stroke or an even fill: of what it can be, JOINED, PATTERNS, BANDS,
//                HATCHES, SLOPES
// IDS            writes 1 + slot of the topmost feature at the centre instead of a colour
#if !defined(STYLES) && (defined(JOINED) || defined(PATTERNS) || defined(BANDS) || defined(HATCHES) || defined(SLOPES))
#define STYLES
#endif
#include "shared/ray.glsl"
#if defined(CLASSES) || defined(CELLS) || defined(POINTS) || defined(FROM_LEVELS)
#define AREA
#endif
#include "technique/static_decals/point.glsl"
#ifdef AREA
#include "technique/static_decals/classes.glsl"
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

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    Position seen = unpack_position(texelFetch(position_texture, pixel, 0));
    LatticePosition position = on_lattice(seen);
#ifdef SLOPES
    set_slope(texelFetch(surface_texture, pixel, 0).xy);
#endif
#ifdef IDS
    id = walk_at(position).found + 1u;  // no slot, plus one, is 0
#elif defined(AREA)
    vec4 surface = texelFetch(surface_texture, pixel, 0);
    // Sky has no surface: a pixel of no size, outside every grid, is done with at once.
    mat2 foot = is_sky(seen) ? mat2(0.0) : footprint(pixel_from_centre(), surface.xy, surface.z) * quanta_per_metre;
#if defined(CLASSES)
    Classed result = classed(position, foot);
    color = result.color;
    gl_FragDepth = result.kind;
#elif defined(CELLS)
    color = composite_cells(position, foot);
#elif defined(POINTS)
    color = composite_points(position, foot);
#else
    color = mean_of_levels(position, foot);
#endif
#else
    color = color_at(position);
#endif
}

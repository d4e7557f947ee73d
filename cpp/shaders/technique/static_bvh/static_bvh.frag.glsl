// Static decals of one data group, by the structures of Zechmeister 2020 (algorithm 3.5, section 4.4.1) and
// of Thöny et al. 2018 (section 3.2).
//
//     pixel ─▶ map position ─▶ cell ─▶ its tree, without a stack: down into boxes that hold the point,
//     else to the right; at a leaf a segment, or a ring's subtree; front to back until nothing shows behind
//
// RINGS          a group of fills, else of strokes
// BOTH           a group of fills and strokes, with INSET or OFFSET for strokes on one side of their rings
// CORNERS        strokes are more than round; with PATTERNS, BANDS or SLOPES as some of them ask for
// GROUND         some patterns are measured along the ground
// HATCHES        some fills are of parallel lines
// UNSORTED       segments lie along a Hilbert curve: the walk goes on to the end
// NEAREST        the nearest line that covers the point is the only one seen
// BORDERS        writes how the nearest border in the pixel runs, nothing where there is none; nearer ones are deeper
// FAR            of BORDERS: some pixels may have very many cells
// SAMPLES        the mean of some of the points of the pixel's area that follow that border, else its centre
// THOENY         lines by how much of the pixel they cover
// HIDDEN         some fills are not seen
// LENS           pixels on one side of the lens's border
// IDS            writes 1 + slot of the topmost feature at the centre, nothing where there is none

// Some flags mean others, and some nothing beside others.
#if (defined(INSET) || defined(OFFSET)) && !defined(BOTH)
#define BOTH
#endif
#if defined(RINGS) && !defined(BOTH)
#undef CORNERS
#undef PATTERNS
#undef GROUND
#undef BANDS
#undef SLOPES
#undef UNSORTED
#undef NEAREST
#undef THOENY
#elif !defined(CORNERS) && (defined(PATTERNS) || defined(BANDS) || defined(SLOPES))
#define CORNERS
#endif
#if !defined(PATTERNS)
#undef GROUND
#endif
#if defined(THOENY) && (defined(BOTH) || defined(IDS) || defined(SAMPLES))
#undef THOENY
#endif
#if defined(BOTH)
#undef RINGS
#undef UNSORTED
#undef NEAREST
#endif
#if defined(IDS)
#undef BORDERS
#endif
#if defined(BORDERS)
#undef THOENY
#endif
#if defined(IDS) || defined(BORDERS)
#undef SAMPLES
#endif
#include "shared/ray.glsl"
#include "technique/static_bvh/tree.glsl"
#if defined(RINGS) || defined(BOTH)
#include "technique/static_bvh/quad_trees.glsl"
#endif
// A file is included where it is first asked for, whatever flags surround it there.
#ifndef RINGS
#include "technique/static_bvh/candidate.glsl"
#ifdef CORNERS
#include "technique/static_bvh/styled_strokes.glsl"
#else
#include "technique/static_bvh/strokes.glsl"
#endif
#endif

uniform usampler2D position_texture;
uniform int first_row;  // of the strip that is drawn
#if defined(SAMPLES) || defined(SLOPES) || defined(THOENY) || defined(BORDERS)
uniform sampler2D surface_texture;
#endif
#ifdef SAMPLES
#include "shared/sample_place.glsl"
uniform sampler2D border_texture;
uniform ivec2 sample_range;  // the first and the one after the last
#endif
#ifdef BOTH
uniform usamplerBuffer bvh_objects;
#endif
#ifdef LENS
#include "technique/static_bvh/lens_share.glsl"
uniform bool inside;
#endif
#if defined(BORDERS) || defined(THOENY)
#include "technique/static_bvh/search.glsl"
#endif
#if !defined(THOENY) && (!defined(BORDERS) || defined(FAR))
#include "technique/static_bvh/walk.glsl"
#endif
#if defined(BORDERS)
#include "technique/static_bvh/find_borders.glsl"
#elif defined(THOENY)
#include "technique/static_bvh/thoeny_walk.glsl"
#endif

#ifdef IDS
uniform uint first_slot;
layout(location = 0) out uint id;
#elif defined(BORDERS)
layout(location = 0) out vec2 border;
#else
layout(location = 0) out vec4 color;
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy) + ivec2(0, first_row);
    Position position = unpack_position(texelFetch(position_texture, pixel, 0));
    if (is_sky(position)) discard;
#ifdef LENS
    if (lens_share(pixel) == (inside ? 0.0 : 1.0)) discard;
#endif
#if defined(SAMPLES) || defined(SLOPES) || defined(THOENY) || defined(BORDERS)
    vec4 surface = texelFetch(surface_texture, pixel, 0);
#endif
#ifdef SLOPES
    gradient = surface.xy;
#endif
#if defined(SAMPLES) || defined(THOENY) || defined(BORDERS)
    mat2 foot = footprint(pixel_from_centre() + vec2(0.0, first_row), surface.xy, surface.z);
#endif
#if defined(BORDERS)
    Borders borders = find_borders(lattice_point(position, vec2(0.0)), quanta_per_metre * foot);
    if (borders.ratio > 1.0) discard;
    border = borders.growth;
    gl_FragDepth = 1.0 - 0.99 * borders.ratio;
#elif defined(THOENY)
    color = lines_at(lattice_point(position, vec2(0.0)), quanta_per_metre * foot);
#elif defined(IDS)
    Found found = walk(lattice_point(position, vec2(0.0)));
    if (found.seen == no_slot) discard;
    id = first_slot + found.seen + 1u;
#elif defined(SAMPLES)
    vec2 growth = texelFetch(border_texture, pixel - ivec2(0, first_row), 0).rg;
    color = vec4(0.0);
    int i = sample_range.x;
    do {
        color += walk(lattice_point(position, foot * sample_place(growth, i, BORDER_SAMPLES))).sum;
    } while (++i < sample_range.y);
    color /= float(sample_range.y - sample_range.x);
#else
    color = walk(lattice_point(position, vec2(0.0))).sum;
#endif
}

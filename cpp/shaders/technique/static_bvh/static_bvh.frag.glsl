// Static decals of one data group, by the structures of Zechmeister 2020 (algorithm 3.5, section 4.4.1) and
// of Thöny et al. 2018 (section 3.2).
//
//     pixel ─▶ map position ─▶ cell ─▶ its tree, without a stack: down into boxes that hold the point,
//     else to the right; at a leaf a segment, or a ring's subtree; front to back until nothing shows behind
//
// RINGS          a group of fills, else of strokes
// BOTH           a group of fills and strokes, with INSET or OFFSET for strokes on one side of their rings
// CORNERS        strokes are more than round; with PATTERNS, BANDS or SLOPES as some of them ask for
// HATCHES        some fills are of parallel lines
// UNSORTED       segments lie along a Hilbert curve: the walk goes on to the end
// NEAREST        the nearest line that covers the point is the only one seen
// SAMPLE         one of the 32 points of the pixel's area, else its centre
// THOENY         lines by how much of the pixel they cover
// IDS            writes 1 + slot of the topmost feature at the centre, nothing where there is none

// Some flags mean others, and some nothing beside others.
#if (defined(INSET) || defined(OFFSET)) && !defined(BOTH)
#define BOTH
#endif
#if defined(RINGS) && !defined(BOTH)
#undef CORNERS
#undef PATTERNS
#undef BANDS
#undef SLOPES
#undef UNSORTED
#undef NEAREST
#undef THOENY
#elif !defined(CORNERS) && (defined(PATTERNS) || defined(BANDS) || defined(SLOPES))
#define CORNERS
#endif
#if defined(THOENY) && (defined(BOTH) || defined(IDS) || defined(SAMPLE))
#undef THOENY
#endif
#if defined(BOTH)
#undef RINGS
#undef UNSORTED
#undef NEAREST
#endif
#if defined(IDS)
#undef SAMPLE
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
#if defined(SAMPLE) || defined(SLOPES) || defined(THOENY)
uniform sampler2D surface_texture;
#endif
#ifdef SAMPLE
#include "shared/sample_offsets.glsl"
uniform int sample_index;
#endif
#ifdef BOTH
uniform usamplerBuffer bvh_objects;
#endif
#ifdef THOENY
#include "technique/static_bvh/thoeny_walk.glsl"
#else
#include "technique/static_bvh/walk.glsl"
#endif

#ifdef IDS
uniform uint first_slot;
layout(location = 0) out uint id;
#else
layout(location = 0) out vec4 color;
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy) + ivec2(0, first_row);
    Position position = unpack_position(texelFetch(position_texture, pixel, 0));
    if (is_sky(position)) discard;
#if defined(SAMPLE) || defined(SLOPES) || defined(THOENY)
    vec4 surface = texelFetch(surface_texture, pixel, 0);
#endif
#ifdef SLOPES
    gradient = surface.xy;
#endif
#if defined(SAMPLE) || defined(THOENY)
    mat2 foot = footprint(pixel_from_centre() + vec2(0.0, first_row), surface.xy, surface.z);
#endif
#if defined(THOENY)
    color = lines_at(lattice_point(position, vec2(0.0)), quanta_per_metre * foot);
#elif defined(IDS)
    Found found = walk(lattice_point(position, vec2(0.0)));
    if (found.seen == no_slot) discard;
    id = first_slot + found.seen + 1u;
#elif defined(SAMPLE)
    color = walk(lattice_point(position, foot * sample_offsets[sample_index])).sum;
#else
    color = walk(lattice_point(position, vec2(0.0))).sum;
#endif
}

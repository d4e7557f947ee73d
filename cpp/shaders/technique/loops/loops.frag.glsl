// LOOPS: features simplified by the view, looked up pixel by pixel.
//
//     pixel ─▶ map position ─▶ lists of the tree ─▶ triangles and edges that are active ─▶ parity, or distance
//
// FILLS, STROKES     what there is
// SEGMENTS           strokes by the segments of all levels, else by triangles
// PATHS              a position has a list at each level of a secondary tree, else one
// SCREEN             a bound in pixels
// BY_DISTANCE        a bound by the distance from the eye
// CIRCLE             a lens on the map
// SAMPLES            the mean of 32 points of the pixel's area, else its centre
// TESTED, ACTIVE     how many primitives were looked at, or active, as colours
// LENS               one side of the lens's border
// IDS                writes 1 + slot of the topmost feature at the centre, nothing where there is none
#include "technique/loops/pixel.glsl"
#include "technique/loops/walk.glsl"
#ifdef SAMPLES
#include "shared/sample_offsets.glsl"
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    Position position = unpack_position(texelFetch(position_texture, pixel, 0));
    if (is_sky(position)) discard;
#ifdef LENS
    float share = share_of_side(pixel);
    if (share == 0.0) discard;
#endif
#if defined(IDS)
    Found found = walk(lattice_point(position, vec2(0.0)));
    if (found.seen == no_slot) discard;
    id = found.seen + 1u;
#elif defined(SAMPLES)
    mat2 foot = footprint_of(pixel);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < sample_count; ++i) sum += walk(lattice_point(position, foot * sample_offsets[i])).sum;
    color = sum / float(sample_count);
#elif defined(TESTED)
    color = heat(walk(lattice_point(position, vec2(0.0))).tested);
#elif defined(ACTIVE)
    color = heat(walk(lattice_point(position, vec2(0.0))).active_count);
#else
    color = walk(lattice_point(position, vec2(0.0))).sum;
#endif
#if defined(LENS) && !defined(IDS)
    color *= share;
#endif
}

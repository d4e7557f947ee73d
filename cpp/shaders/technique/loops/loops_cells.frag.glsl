// LOOPS: features simplified by the view, looked up in cells that were made for it.
//
//     pixel ─▶ map position ─▶ cell ─▶ edges that are active: parity, or distance
//
// FILLS, STROKES     what there is
// SAMPLES            the mean of 32 points of the pixel's area, else its centre
// TRANSLUCENT        some feature is
// LENS               one side of the lens's border
// TESTED, ACTIVE     how many edges were looked at, as colours: all of them are active
// IDS                writes 1 + slot of the topmost feature at the centre, nothing where there is none
#include "technique/loops/pixel.glsl"
#include "technique/loops/cells.glsl"
#ifdef SAMPLES
#include "technique/loops/cell_samples.glsl"
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    Position position = unpack_position(texelFetch(position_texture, pixel, 0));
    if (is_sky(position)) discard;
#ifdef LENS
    float share = share_of_side(pixel);
    if (share == 0.0) discard;
#endif
#ifdef SAMPLES
    color = mean_of_samples(position, footprint_of(pixel) * quanta_per_metre);
#else
    Found found = walk(lattice_point(position, vec2(0.0)));
#if defined(IDS)
    if (found.seen == no_slot) discard;
    id = found.seen + 1u;
#elif defined(TESTED) || defined(ACTIVE)
    color = heat(found.edges);
#else
    color = found.sum;
#endif
#endif
#if defined(LENS) && !defined(IDS)
    color *= share;
#endif
}

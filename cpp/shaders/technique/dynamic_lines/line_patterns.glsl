// Patterns along lines (line_styles.h): marks that repeat by the length of the ground, in octaves of the zoom.
//
//     seen from afar    |==  ==  ==  ==  ==  ==  ==  ==|     a pixel of 2^-k metres, k the whole number nearest to what the
//     twice as near     |====    ====    ====    ====  |     pixel's depth says: marks lie on the ground and never crawl
//
// A length of the ground is counted around in 32 bits, so that the phase in any octave is what a shift leaves.
#include "shared/stroke.glsl"
#include "technique/dynamic_lines/line_styles.h"

uniform samplerBuffer line_patterns;
uniform int first_octave;

// A stretch of a line and its pattern; phases are counted in periods.
struct Phases {
    int first_mark;
    int end_mark;
    float from;
    float to;
};

// `arc`: of the stretch's beginning, and its length in 2^32 of that as the bits of a float.
Phases phases_of(uint pattern, uvec2 arc, float pixels_per_metre) {
    vec4 head = texelFetch(line_patterns, int(pattern));
    // The exponent of a float is the whole part of its logarithm.
    int octave = (floatBitsToInt(pixels_per_metre * 1.41421356) >> 23) - 127 - first_octave;
    octave = head.z > 0.5 ? 0 : clamp(octave, 0, PATTERN_OCTAVES);
    float from = float(arc.x << octave) / 4294967296.0 + head.y;
    float length = uintBitsToFloat(arc.y) * exp2(float(octave));
    return Phases(int(pattern) + 1, int(pattern) + 1 + int(head.x), from, from + length);
}

// The share of the line's width that is covered at a phase; below 0 between marks.
float width_at(Phases phases, float phase) {
    float share = -1.0;
    int mark = phases.first_mark;
    do {
        share = max(share, mark_width(texelFetch(line_patterns, mark), fract(phase)));
    } while (++mark < phases.end_mark);
    return share;
}

// At a share of the stretch, and at both its ends.
vec3 widths_along(Phases phases, float share) {
    return vec3(width_at(phases, mix(phases.from, phases.to, share)), width_at(phases, phases.from),
                width_at(phases, phases.to));
}

// Which samples of a pixel's area lie in stretches that come back with a period: marks along a line, lines of a hatch.
//
// Stretches that are wide against the pixel are cut out by half planes. Of finer ones, where each half plane would be
// rounded by itself, samples are asked one by one, and as many of them are taken as is the stretches' share of the pixel.
#include "shared/half_planes.glsl"

const float finest_period = 0.75;  // in pixels

// A phase at the pixel's centre, and by how much it grows for a pixel to the right and one up.
struct Phase {
    float centre;  // from 0 to 1
    vec2 growth;
    float reach;   // from the centre to the farthest corner
    Direction direction;
};

Phase phase_of(float centre, vec2 growth) {
    return Phase(fract(centre), growth, half_extent(growth), direction_of(growth));
}

bool is_fine(Phase phase) {
    return 2.0 * phase.reach * finest_period > 1.0;
}

// How much of all stretches before a phase has come by.
float stretch_until(float phase, float begin, float end) {
    return floor(phase) * (end - begin) + clamp(fract(phase) - begin, 0.0, end - begin);
}

// The share of the pixel in a stretch, from 0 to 1: means along the longer side, at four places of the shorter one.
float stretch_share(Phase phase, float begin, float end) {
    vec2 sides = abs(phase.growth);
    float longer = max(max(sides.x, sides.y), 1e-9), shorter = min(sides.x, sides.y);
    float sum = 0.0;
    int i = 0;
    do {
        float middle = phase.centre + shorter * (0.25 * float(i) - 0.375);
        sum += stretch_until(middle + 0.5 * longer, begin, end) - stretch_until(middle - 0.5 * longer, begin, end);
    } while (++i < 4);
    return 0.25 * sum / longer;
}

// The first and the last period whose stretch reaches into the pixel; no loop where they are fine.
vec2 turns_of(Phase phase, float begin, float end) {
    return is_fine(phase) ? vec2(0.0) : vec2(ceil(phase.centre - phase.reach - end), floor(phase.centre + phase.reach - begin));
}

uvec2 samples_between(Phase phase, float begin, float end) {
    return samples_beyond(phase.direction, phase.centre - begin) & ~samples_beyond(phase.direction, phase.centre - end);
}

// Of these samples, those in stretches that are fine.
uvec2 samples_in_fine(Phase phase, float begin, float end, uvec2 samples) {
    int count = int(clamp(stretch_share(phase, begin, end), 0.0, 1.0) * float(count_of(samples)) + 0.5);
    uvec2 mask = no_samples;
    int i = 0;
    do {
        float at = fract(phase.centre + dot(phase.growth, sample_offsets[i]) - begin);
        mask |= sample_if(at <= end - begin, i);
    } while (++i < sample_count && is_fine(phase));
    mask &= samples;
    int missing;
    do {
        uvec2 others = samples & ~mask;
        missing = count - count_of(mask);
        if (missing > 0) mask = samples & ~without_first(others);
        if (missing < 0) mask = without_first(mask);
    } while (abs(missing) > 1 && is_fine(phase));
    return is_fine(phase) ? mask : no_samples;
}

// Front-to-back composition of masks: colours over each other, each of a pixel's samples for itself.
//
// SAMPLE_MASK   the type of a set of samples, where it and its functions are not those of sample_masks.glsl
#ifndef SAMPLE_MASK
#include "shared/sample_masks.glsl"
#define SAMPLE_MASK uvec2
#endif

struct Samples {
    SAMPLE_MASK open;  // those that still see something behind what was added
    vec4 sum;
#ifdef TRANSLUCENT
    float clear[sample_count];  // how much of what lies behind shows through
#endif
};

Samples samples_of(SAMPLE_MASK open) {
    Samples samples;
    samples.open = open;
    samples.sum = vec4(0.0);
#ifdef TRANSLUCENT
    int i = 0;
    do {
        samples.clear[i] = 1.0;
    } while (++i < sample_count);
#endif
    return samples;
}

void lay_under(inout Samples samples, SAMPLE_MASK mask, vec4 straight) {
    mask &= samples.open;
#ifdef TRANSLUCENT
    float weight = 0.0;
    int i = 0;
    if (!is_empty(mask)) {
        do {
            float taken = has_sample(mask, i) ? samples.clear[i] * straight.a : 0.0;
            samples.clear[i] -= taken;
            weight += taken;
        } while (++i < sample_count);
    }
    if (straight.a == 1.0) samples.open &= ~mask;
#else
    float weight = float(count_of(mask));
    samples.open &= ~mask;
#endif
    samples.sum += weight * vec4(straight.rgb, 1.0);
}

// Sets of a pixel's 64 samples, a bit each.
#include "shared/area_samples.h"

const int sample_count = AREA_SAMPLE_COUNT;
const vec2 sample_offsets[sample_count] = vec2[](AREA_SAMPLE_OFFSETS(vec2));

const uvec2 all_samples = uvec2(0xFFFFFFFFu);
const uvec2 no_samples = uvec2(0u);

bool is_empty(uvec2 samples) {
    return (samples.x | samples.y) == 0u;
}

int count_of(uvec2 samples) {
    return bitCount(samples.x) + bitCount(samples.y);
}

// Sample 0 where there is none.
int first_of(uvec2 samples) {
    return max(samples.x != 0u ? findLSB(samples.x) : 32 + findLSB(samples.y), 0) & (sample_count - 1);
}

// One sample, or none where it does not count.
uvec2 sample_if(bool counts, int index) {
    uint bit = uint(counts) << (index & 31);
    return index < 32 ? uvec2(bit, 0u) : uvec2(0u, bit);
}

bool has_sample(uvec2 samples, int index) {
    return ((index < 32 ? samples.x : samples.y) >> (index & 31) & 1u) != 0u;
}

uvec2 without_first(uvec2 samples) {
    return samples.x != 0u ? uvec2(samples.x & (samples.x - 1u), samples.y) : uvec2(0u, samples.y & (samples.y - 1u));
}

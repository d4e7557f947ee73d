// The samples that are drawn in passes of their own (sample_offsets.h).
#include "shared/sample_offsets.h"

const int sample_count = SAMPLE_COUNT;
const vec2 sample_offsets[sample_count] = vec2[](SAMPLE_OFFSETS(vec2));

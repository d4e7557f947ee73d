// Exclusive prefix sums in place, by runs of values.
//
//     values   3 1 2 | 4 1 0 | 2        sums of runs    6 5 2  ─▶ their own prefix sums    0 6 11
//     result   0 3 4 | 6 10 11 | 11     TOTALS writes the sums; without it each run adds up from its sum on
#include "technique/dynamic_lines/items.glsl"

layout(std430, binding = 0) buffer Values {
    uint values[];
};
layout(std430, binding = 1) buffer Sums {
    uint sums[];
};

uniform uint value_count;
uniform uint run_length;

void main() {
    uint run = this_item();
    uint at = run * run_length;
    uint end = min(at + run_length, value_count);
    if (at >= end) return;
#ifdef TOTALS
    uint sum = 0u;
    do {
        sum += values[at];
    } while (++at < end);
    sums[run] = sum;
#else
    uint sum = sums[run];
    do {
        uint value = values[at];
        values[at] = sum;
        sum += value;
    } while (++at < end);
#endif
}

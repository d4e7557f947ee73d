// Where in a pixel the samples lie that are drawn in passes of their own, counted from its centre: a scrambled
// (0, 5, 2)-net (Sobol' points), chosen for the smallest error on straight edges by tools/sample_pattern.py. Read by
// C++ and GLSL alike, each with its own `vec2`.
#ifndef DECALGL_SAMPLE_OFFSETS_H
#define DECALGL_SAMPLE_OFFSETS_H

#define SAMPLE_COUNT 32
#define SAMPLE_OFFSETS(vec2)                                                              \
    vec2(-0.453125, 0.140625), vec2(0.078125, -0.421875), vec2(-0.109375, -0.015625),     \
        vec2(0.421875, 0.359375), vec2(-0.296875, -0.328125), vec2(0.203125, 0.046875),   \
        vec2(-0.234375, 0.484375), vec2(0.296875, -0.140625), vec2(-0.421875, -0.234375), \
        vec2(0.015625, 0.421875), vec2(-0.046875, 0.078125), vec2(0.453125, -0.265625),   \
        vec2(-0.359375, 0.296875), vec2(0.140625, -0.109375), vec2(-0.171875, -0.484375), \
        vec2(0.359375, 0.234375), vec2(-0.484375, -0.390625), vec2(0.109375, 0.171875),   \
        vec2(-0.078125, 0.328125), vec2(0.390625, -0.046875), vec2(-0.265625, 0.015625),  \
        vec2(0.234375, -0.359375), vec2(-0.203125, -0.171875), vec2(0.265625, 0.453125),  \
        vec2(-0.390625, 0.390625), vec2(0.046875, -0.203125), vec2(-0.015625, -0.296875), \
        vec2(0.484375, 0.109375), vec2(-0.328125, -0.078125), vec2(0.171875, 0.265625),   \
        vec2(-0.140625, 0.203125), vec2(0.328125, -0.453125)

#endif

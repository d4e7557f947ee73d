// Half floats that are never below the value they stand for. GLSL reads two of them with unpackHalf2x16.
#pragma once

#include <cmath>
#include <cstdint>

namespace decalgl::loops {

constexpr uint16_t half_infinity = 0x7C00;

inline double half_to_double(uint16_t half) {
    const int exponent = half >> 10;
    const int fraction = half & 0x3FF;
    if (exponent == 31)
        return INFINITY;
    return exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
}

// The least half that is at least `value`, which is not negative.
inline uint16_t half_not_below(double value) {
    if (!(value <= 65504.0))
        return half_infinity;
    int exponent = 0;
    std::frexp(value, &exponent);
    const int scale = std::max(exponent, -13) - 11;
    // A fraction that is rounded up to the next power of two carries into the exponent.
    const auto fraction = static_cast<uint32_t>(std::ceil(std::ldexp(value, -scale)));
    return static_cast<uint16_t>(fraction < 1024 ? fraction : uint32_t(scale + 24) * 1024 + fraction);
}

}  // namespace decalgl::loops

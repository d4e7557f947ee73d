// Half floats that are never below the value they stand for. GLSL reads two of them with unpackHalf2x16.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

namespace decalgl::loops {

constexpr uint16_t half_infinity = 0x7C00;

inline double half_to_double(uint16_t half) {
    if (half >= half_infinity)
        return INFINITY;
    // The bits of a float whose exponent is as much too small as that of halves is: 2^-112.
    const uint32_t bits = uint32_t{half} << 13;
    float small = 0.0F;
    std::memcpy(&small, &bits, sizeof(small));
    return 0x1p112 * double{small};
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

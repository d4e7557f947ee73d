// Places along Hilbert's curve: what is close on it is close on the map. Thöny et al. 2018, section 3.1, sort
// the segments of a cell along such a curve, by their midpoints.
//
//     order 1   1--2      each quadrant holds the curve of one order less, turned so that the ends meet
//               |  |
//               0  3
#pragma once

#include <cstdint>
#include <utility>

namespace decalgl::bvh {

// Of a point with coordinates of 16 bits, on the curve of order 16.
inline uint32_t hilbert_place(uint32_t x, uint32_t y) {
    uint32_t place = 0;
    for (uint32_t side = 1U << 15; side > 0; side >>= 1) {
        const bool right = (x & side) != 0;
        const bool upper = (y & side) != 0;
        place = place << 2 | (right ? (upper ? 2U : 3U) : (upper ? 1U : 0U));
        if (!upper) {
            if (right) {
                x = ~x;
                y = ~y;
            }
            std::swap(x, y);
        }
    }
    return place;
}

}  // namespace decalgl::bvh

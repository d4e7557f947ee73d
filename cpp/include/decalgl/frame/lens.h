// The lens: a part of the picture in which layers look otherwise.
//
//     a circle on the screen, which stays round        rings on the map, which lie on the terrain
#pragma once

#include <cstdint>
#include <vector>

namespace decalgl {

struct Lens {
    // In pixels from the picture's upper left corner, as pixels' centres lie at halves.
    double x = 0.0;
    double y = 0.0;
    double radius = 0.0;
    // In place of the circle, where there are any: closed rings in the scene's coordinates, inside by the even-odd rule.
    std::vector<double> coordinates;
    std::vector<int64_t> ring_offsets;

    bool is_on_map() const { return !coordinates.empty(); }
    // Whether a pixel's centre is inside; it shows the map at (map_x, map_y).
    bool contains(double pixel_x, double pixel_y, double map_x, double map_y) const;
};

// Throws Error(input) for what is no lens.
void validate(const Lens& lens);

}  // namespace decalgl

// Levels of detail of LOOPS: how many metres a border or line may be off, by place. They change from frame to
// frame, with nothing to be prepared anew.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace decalgl {

// Whose distance and pixels count, where that is not the camera of the view (figure 13 of the paper).
struct DetailEye {
    std::array<double, 3> eye{};
    std::array<double, 3> forward{};  // unit vector
    double pixels = 0.0;              // of the picture's height, for a metre one metre ahead; 0: orthographic
    double metres_per_pixel = 0.0;    // orthographic
};

// A step of a tolerance that rises with the distance; it is linear between steps, and constant beyond them.
struct DetailStep {
    double distance;
    double tolerance;
};

// Each is a bound; where several are given, the least of them counts.
struct LoopsDetail {
    // Metres, the same everywhere; below 0: none.
    double uniform = -1.0;
    // Pixels on the screen; below 0: none.
    double screen = 0.5;
    // Metres by distance from the eye; empty: none.
    std::vector<DetailStep> steps;
    // Within a circle on the map, metres; below 0: no such lens.
    double lens = -1.0;
    std::array<double, 2> lens_centre{};
    double lens_radius = 0.0;
    // Else the camera of the view. One eye for the bounds above.
    bool has_eye = false;
    DetailEye eye;
    // What is drawn in place of the layers: nothing else, or how many primitives each pixel had to look at or found
    // active, as colours (figures 13 to 15).
    enum class Shows { layers, tested, active } shows = Shows::layers;
    double heat_top = 64.0;  // primitives that have the last colour
};

constexpr size_t most_detail_steps = 8;

bool operator==(const LoopsDetail& a, const LoopsDetail& b);

// Throws Error(input) that names what is out of range.
void validate(const LoopsDetail& detail);

}  // namespace decalgl

// Cameras: where the eye is and how the picture lies before it. Scene coordinates, metres, z up.
#pragma once

#include <glm/vec3.hpp>

#include "decalgl/core/position_grid.h"

namespace decalgl {

struct Camera {
    glm::dvec3 eye{0.0, 0.0, 1.0};
    glm::dvec3 target{0.0, 0.0, 0.0};
    glm::dvec3 up{0.0, 0.0, 1.0};
    double fov = 45.0;         // vertical, degrees; perspective cameras
    double view_height = 0.0;  // metres from the picture's lower to its upper edge; above 0: orthographic

    static Camera look_at(glm::dvec3 eye, glm::dvec3 target, double fov = 45.0);

    // Around a point: azimuth in degrees clockwise from north, elevation in degrees above the horizon, both
    // of the direction from the target to the eye.
    static Camera orbit(glm::dvec3 target, double distance, double azimuth, double elevation,
                        double fov = 45.0);

    // Straight down, north up, orthographic: the bounds fill a picture of this aspect (width / height).
    static Camera top_down(const Bounds& bounds, double eye_height, double aspect);

    bool orthographic() const { return view_height > 0.0; }
};

// Unit vectors of the picture in the scene.
struct CameraBasis {
    glm::dvec3 right;
    glm::dvec3 up;
    glm::dvec3 forward;
};

// Throws Error(input) where the camera has no direction or is not finite.
CameraBasis basis_of(const Camera& camera);

}  // namespace decalgl

#include "decalgl/frame/camera.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "decalgl/core/error.h"

namespace decalgl {
namespace {

constexpr double radians = 3.14159265358979323846 / 180.0;

// Beyond, the square of a distance times a size would leave the numbers behind.
constexpr double farthest = 1e12;

bool is_near(glm::dvec3 v) {
    return std::abs(v.x) <= farthest && std::abs(v.y) <= farthest && std::abs(v.z) <= farthest;
}

}  // namespace

Camera Camera::look_at(glm::dvec3 eye, glm::dvec3 target, double fov) {
    Camera camera;
    camera.eye = eye;
    camera.target = target;
    camera.fov = fov;
    return camera;
}

Camera Camera::orbit(glm::dvec3 target, double distance, double azimuth, double elevation, double fov) {
    const double across = std::cos(elevation * radians);
    const glm::dvec3 direction(std::sin(azimuth * radians) * across, std::cos(azimuth * radians) * across,
                               std::sin(elevation * radians));
    return look_at(target + distance * direction, target, fov);
}

Camera Camera::top_down(const Bounds& bounds, double eye_height, double aspect) {
    const double x = 0.5 * (bounds.min_x + bounds.max_x);
    const double y = 0.5 * (bounds.min_y + bounds.max_y);
    Camera camera = look_at({x, y, eye_height}, {x, y, eye_height - 1.0});
    camera.view_height = std::max(bounds.max_y - bounds.min_y, (bounds.max_x - bounds.min_x) / aspect);
    return camera;
}

CameraBasis basis_of(const Camera& camera) {
    if (!is_near(camera.eye) || !is_near(camera.target) || !is_near(camera.up))
        throw Error(ErrorKind::input, "camera: eye, target and up must be finite and at most 1e12 m away");
    if (!camera.orthographic() && !(camera.fov > 0.0 && camera.fov < 180.0))
        throw Error(ErrorKind::input, "camera: fov must lie between 0 and 180 degrees");
    if (!(camera.view_height >= 0.0 && camera.view_height <= farthest))
        throw Error(ErrorKind::input, "camera: view_height must be a positive length in metres");
    const glm::dvec3 towards = camera.target - camera.eye;
    if (!(glm::length(towards) > 0.0))
        throw Error(ErrorKind::input, "camera: eye and target are the same point; move one of them");
    const glm::dvec3 forward = glm::normalize(towards);
    glm::dvec3 right = glm::cross(forward, camera.up);
    // Straight up or down: north is up in the picture.
    if (glm::length(right) < 1e-9 * std::max(glm::length(camera.up), 1e-300))
        right = {1.0, 0.0, 0.0};
    right = glm::normalize(right);
    return {right, glm::cross(right, forward), forward};
}

}  // namespace decalgl

#include "technique/loops/view_detail.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "shared/view_block.h"
#include "technique/loops/half_float.h"
#include "technique/view_base.h"

namespace decalgl::loops {
namespace {

using Place = std::array<double, 3>;

constexpr double margin_pixels = 2.0;

// A convex polygon without what lies beyond a plane.
std::vector<Place> cut(const std::vector<Place>& polygon, const SightPlane& plane) {
    std::vector<Place> kept;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const Place &a = polygon[i], &b = polygon[i + 1 == polygon.size() ? 0 : i + 1];
        const double at_a = plane.at(a), at_b = plane.at(b);
        if (at_a >= 0.0)
            kept.push_back(a);
        if ((at_a >= 0.0) != (at_b >= 0.0)) {
            const double t = at_a / (at_a - at_b);
            kept.push_back({a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])});
        }
    }
    return kept;
}

// The faces of a box.
std::array<std::vector<Place>, 6> faces_of(const Place& low, const Place& high) {
    std::array<std::vector<Place>, 6> faces;
    for (size_t face = 0; face < 6; ++face) {
        const size_t axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (const auto& [at_u, at_v] :
             {std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1)}) {
            Place corner{};
            corner[axis] = face % 2 == 0 ? low[axis] : high[axis];
            corner[u] = at_u == 0 ? low[u] : high[u];
            corner[v] = at_v == 0 ? low[v] : high[v];
            faces[face].push_back(corner);
        }
    }
    return faces;
}

}  // namespace

DetailEye detail_eye_of(const View& view) {
    const ViewBlock& block = *view.block;
    DetailEye eye;
    eye.eye = eye_of(view);
    for (int axis = 0; axis < 3; ++axis)
        eye.forward[size_t(axis)] = double{block.forward[axis]};
    const auto step = double{glm::length(glm::vec3(block.ray_direction_dy))};
    eye.pixels = step > 0.0 ? 1.0 / step : 0.0;
    eye.corner = 1.0 / std::hypot(1.0, 0.5 * step * std::hypot(double(view.width), double(view.height)));
    eye.metres_per_pixel = step > 0.0 ? 0.0 : double{glm::length(glm::vec3(block.ray_origin_dy))};
    return eye;
}

Sight::Sight(const View& view, const Lattice& lattice, const GroundRange& heights) {
    const ViewBlock& block = *view.block;
    const DetailEye eye = detail_eye_of(view);
    const bool is_flat = eye.pixels == 0.0;
    const glm::dvec3 forward(block.forward), direction(block.ray_direction);
    const glm::dvec3 at_eye(eye.eye[0] - lattice.left, eye.eye[1] - lattice.bottom, eye.eye[2]);
    const glm::dvec3 base = at_eye + double{block.forward.w} * forward;
    const auto add = [&](glm::dvec3 normal, glm::dvec3 place) {
        normal = glm::normalize(normal);
        // The middle of the picture is seen.
        if (glm::dot(normal, base + direction - place) < 0.0)
            normal = -normal;
        planes_.push_back(
            {{normal.x, normal.y, normal.z}, std::hypot(normal.x, normal.y), -glm::dot(normal, place)});
    };
    const glm::dvec3 origin_dx(block.ray_origin_dx), origin_dy(block.ray_origin_dy);
    const glm::dvec3 direction_dx(block.ray_direction_dx), direction_dy(block.ray_direction_dy);
    for (const double side : {-1.0, 1.0}) {
        const double x = side * (0.5 * view.width + margin_pixels),
                     y = side * (0.5 * view.height + margin_pixels);
        add(glm::cross(direction + x * direction_dx, origin_dy + direction_dy), base + x * origin_dx);
        add(glm::cross(direction + y * direction_dy, origin_dx + direction_dx), base + y * origin_dy);
    }
    if (!is_flat)
        add(forward, at_eye);
    find_box({at_eye.x, at_eye.y, at_eye.z}, lattice, heights);
}

void Sight::find_box(const Place& eye, const Lattice& lattice, const GroundRange& heights) {
    const LatticeBox& terrain = lattice.terrain;
    const Place low = {terrain.min_x * lattice.quantum, terrain.min_y * lattice.quantum,
                       double{heights.lowest} - 1e-3};
    const Place high = {terrain.max_x * lattice.quantum, terrain.max_y * lattice.quantum,
                        double{heights.highest} + 1e-3};
    const auto add = [&](const Place& place) {
        const auto quanta = [&](double metres) {
            return static_cast<int32_t>(std::floor(metres / lattice.quantum));
        };
        box_.add(LatticePoint{quanta(place[0]) - 2, quanta(place[1]) - 2});
        box_.add(LatticePoint{quanta(place[0]) + 2, quanta(place[1]) + 2});
    };
    for (std::vector<Place>& face : faces_of(low, high)) {
        for (const SightPlane& plane : planes_)
            face = cut(face, plane);
        for (const Place& corner : face)
            add(corner);
    }
    bool is_inside = true;
    for (size_t axis = 0; axis < 3; ++axis)
        is_inside = is_inside && low[axis] <= eye[axis] && eye[axis] <= high[axis];
    if (is_inside)
        add(eye);
}

bool Sight::operator==(const Sight& other) const {
    const auto same = [](const SightPlane& a, const SightPlane& b) {
        return a.normal == b.normal && a.offset == b.offset;
    };
    return planes_.size() == other.planes_.size() &&
           std::equal(planes_.begin(), planes_.end(), other.planes_.begin(), same);
}

ViewDetail::ViewDetail(const LoopsDetail& detail, const DetailEye& eye, const Sight& sight,
                       const Lattice& lattice, const GroundRange& heights)
    : detail_(detail),
      eye_(eye),
      sight_(sight),
      quantum_(lattice.quantum),
      length_(lattice.quantum / length_scale),
      lowest_(double{heights.lowest}),
      height_step_(std::max(double{heights.highest} - double{heights.lowest}, 1e-6) / 65535.0),
      forward_on_map_(std::hypot(eye.forward[0], eye.forward[1])),
      screen_slope_(eye.pixels == 0.0 ? 0.0 : detail.screen * eye.corner / eye.pixels),
      screen_least_(detail.screen * eye.metres_per_pixel) {
    eye_.eye[0] -= lattice.left;
    eye_.eye[1] -= lattice.bottom;
    detail_.lens_centre[0] -= lattice.left;
    detail_.lens_centre[1] -= lattice.bottom;
}

Verdict ViewDetail::judge(const Activation& activation, double reach, bool is_inside) const {
    const double x = quantum_ * activation.x, y = quantum_ * activation.y;
    const double radius = length_ * half_to_double(static_cast<uint16_t>(activation.error_and_radius >> 16));
    const double error = length_ * half_to_double(static_cast<uint16_t>(activation.error_and_radius));
    const double low = lowest_ + height_step_ * (activation.lowest_and_highest & 0xFFFFu);
    const double high = lowest_ + height_step_ * (activation.lowest_and_highest >> 16);
    // Most are too small, and only what is not is looked for in the picture.
    if (!(error > tolerance(x, y, radius, low, high)))
        return {false, false};
    if (is_inside)
        return {true, true};
    is_inside = true;
    for (const SightPlane& plane : sight_.planes()) {
        const double middle = plane.normal[0] * x + plane.normal[1] * y + plane.offset;
        const double beside = plane.on_map * (radius + reach);
        const double below = plane.normal[2] * low, above = plane.normal[2] * high;
        if (middle + beside + std::max(below, above) < 0.0)
            return {false, false};
        is_inside = is_inside && middle - beside + std::min(below, above) >= 0.0;
    }
    return {true, is_inside};
}

double ViewDetail::tolerance(double x, double y, double radius, double low, double high) const {
    double bound = detail_.uniform >= 0.0 ? detail_.uniform : INFINITY;
    const double dx = x - eye_.eye[0], dy = y - eye_.eye[1];
    const double below = low - eye_.eye[2], above = high - eye_.eye[2];
    if (detail_.screen >= 0.0) {
        const double depth = eye_.forward[0] * dx + eye_.forward[1] * dy - forward_on_map_ * radius +
                             std::min(eye_.forward[2] * below, eye_.forward[2] * above);
        bound = std::min(bound, screen_slope_ * std::max(depth, 0.0) + screen_least_);
    }
    if (!detail_.steps.empty()) {
        const double beside = std::max(std::hypot(dx, dy) - radius, 0.0);
        const double nearest = std::hypot(beside, std::max({0.0, below, -above}));
        double stepped = detail_.steps[0].tolerance;
        for (size_t i = 1; i < detail_.steps.size(); ++i) {
            const DetailStep &from = detail_.steps[i - 1], &to = detail_.steps[i];
            stepped += (to.tolerance - from.tolerance) *
                       std::clamp((nearest - from.distance) / (to.distance - from.distance), 0.0, 1.0);
        }
        bound = std::min(bound, stepped);
    }
    if (detail_.lens >= 0.0 &&
        std::hypot(x - detail_.lens_centre[0], y - detail_.lens_centre[1]) - radius <= detail_.lens_radius)
        bound = std::min(bound, detail_.lens);
    return bound;
}

}  // namespace decalgl::loops

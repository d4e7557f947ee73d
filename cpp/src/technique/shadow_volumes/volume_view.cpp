#include "technique/shadow_volumes/volume_view.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "technique/view_base.h"

namespace decalgl::volume {
namespace {

// A lattice number that is near the base, whole, and what is left of it.
int32_t whole_part(double place) {
    return static_cast<int32_t>(std::clamp(std::floor(place), -lattice_extent, lattice_extent));
}

}  // namespace

VolumeView::VolumeView(const View& view, const Lattice& lattice, int width, int height)
    : block_(view.block),
      quantum_(lattice.quantum),
      pixels_apart_(2.0 * view.terrain_error + 1.0),
      width_(width),
      height_(height) {
    const std::array<double, 3> base = base_of(view);
    const Vector2 place = lattice.place(base[0], base[1]);
    base_ = {place.x, place.y};
    base_place_ = {whole_part(place.x), whole_part(place.y)};
    base_past_ = glm::vec2((base_ - glm::dvec2(base_place_)) * quantum_);
}

glm::dvec3 VolumeView::relative(double x, double y, double height) const {
    const glm::dvec2 place = (glm::dvec2(x, y) - base_) * quantum_;
    return {place.x, place.y,
            height - static_cast<double>(block_->base_sample_fraction.z) -
                static_cast<double>(block_->base_sample_fraction.w)};
}

// The corners of its box on the screen; all of the screen where one of them is behind the eye.
ScreenBox VolumeView::box_of(const Volume& volume) const {
    glm::dvec2 low(1e30), high(-1e30);
    int behind = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const bool is_lid = (corner & 4) != 0;
        glm::dvec3 at =
            relative(corner & 1 ? volume.box.max_x : volume.box.min_x,
                     corner & 2 ? volume.box.max_y : volume.box.min_y,
                     static_cast<double>(is_lid ? volume.heights.highest : volume.heights.lowest));
        const glm::dvec3 forward(block_->forward);
        const double along = glm::dot(forward, at);
        const double pixel =
            glm::length(glm::dvec3(block_->ray_origin_dy) + along * glm::dvec3(block_->ray_direction_dy));
        const double apart =
            pixels_apart_ * pixel + 2e-6 * std::abs(static_cast<double>(block_->forward.w) + along);
        at.z += is_lid ? apart : -apart;
        const glm::dvec4 clip = glm::dmat4(block_->clip_from_base) * glm::dvec4(at, 1.0);
        if (clip.w <= 0.0) {
            ++behind;
            continue;
        }
        const glm::dvec2 place = glm::dvec2(clip) / clip.w;
        low = glm::min(low, place);
        high = glm::max(high, place);
    }
    if (behind == 8)
        return {};
    if (behind > 0)
        return {0, 0, width_, height_};
    const auto pixel = [](double place, int size, int first, double margin, int most) {
        const double at = 0.5 * (place + 1.0) * size - first + margin;
        return static_cast<int>(std::clamp(std::floor(at), 0.0, static_cast<double>(most)));
    };
    const glm::ivec4& picture = block_->picture;
    return {
        pixel(low.x, picture.z, picture.x, -2.0, width_), pixel(low.y, picture.w, picture.y, -2.0, height_),
        pixel(high.x, picture.z, picture.x, 3.0, width_), pixel(high.y, picture.w, picture.y, 3.0, height_)};
}

}  // namespace decalgl::volume

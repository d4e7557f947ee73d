// How strokes with a slope correction are measured at a place on the terrain: shaders/shared/stroke.glsl in double
// precision.
#pragma once

#include <algorithm>
#include <cmath>

#include "vector/stroke_reach.h"

namespace decalgl {

// Level ground where nothing else is said.
class Slope {
public:
    Slope() = default;
    // `forward_z`: of the camera's view direction.
    Slope(Vector2 gradient, double forward_z) : gradient_(gradient) {
        const double steepness = dot(gradient, gradient);
        stretch_ = steepness > 0.0 ? (std::sqrt(1.0 + steepness) - 1.0) / steepness : 0.0;
        const double looks_down = std::clamp(-forward_z, 0.0, 1.0);
        thoeny_width_ = (1.0 - looks_down) / std::sqrt(1.0 + steepness) + looks_down;
    }

    // A vector on the map as one of the tangent plane, as long as it is there.
    Vector2 tangent(Vector2 v) const {
        const double rise = stretch_ * dot(gradient_, v);
        return {v.x + rise * gradient_.x, v.y + rise * gradient_.y};
    }
    // What Thöny et al. multiply widths by.
    double thoeny_width() const { return thoeny_width_; }

private:
    Vector2 gradient_{};
    double stretch_ = 0.0;
    double thoeny_width_ = 1.0;
};

}  // namespace decalgl

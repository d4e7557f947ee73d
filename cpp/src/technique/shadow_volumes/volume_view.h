// Which volumes a view shows, and where on the screen.
#pragma once

#include <algorithm>

#include "decalgl/technique/technique.h"
#include "shared/view_block.h"
#include "technique/shadow_volumes/prepared_volumes.h"

namespace decalgl::volume {

// Pixels of the rectangle in hand; right and top do not belong to it.
struct ScreenBox {
    int left = 0;
    int bottom = 0;
    int right = 0;
    int top = 0;

    bool empty() const { return left >= right || bottom >= top; }
    void add(const ScreenBox& other) {
        if (other.empty())
            return;
        if (empty()) {
            *this = other;
            return;
        }
        left = std::min(left, other.left);
        bottom = std::min(bottom, other.bottom);
        right = std::max(right, other.right);
        top = std::max(top, other.top);
    }
};

class VolumeView {
public:
    VolumeView() = default;
    // `width`, `height`: of the rectangle in hand.
    VolumeView(const View& view, const Lattice& lattice, int width, int height);

    // Where a volume may show; empty: nowhere.
    ScreenBox box_of(const Volume& volume) const;

    // The base on the lattice: a whole place, and metres past it.
    glm::ivec2 base_place() const { return base_place_; }
    glm::vec2 base_past() const { return base_past_; }
    const glm::ivec4& picture() const { return block_->picture; }

private:
    glm::dvec3 relative(double x, double y, double height) const;

    const ViewBlock* block_ = nullptr;
    double quantum_ = 1.0;
    double pixels_apart_ = 0.0;
    glm::ivec2 base_place_{0};
    glm::vec2 base_past_{0.0F};
    glm::dvec2 base_{0.0};  // quanta
    int width_ = 0;
    int height_ = 0;
};

}  // namespace decalgl::volume

// Where the base of a view lies, which its uniform block holds in parts (shaders/shared/view_block.h), and its eye.
#pragma once

#include <array>

#include "decalgl/technique/technique.h"
#include "shared/view_block.h"

namespace decalgl {

// x, y, height in the scene's coordinates.
inline std::array<double, 3> base_of(const View& view) {
    const ViewBlock& block = *view.block;
    return {view.positions.origin_x + block.base_block.x * view.positions.block_size +
                static_cast<double>(block.base_offset.x),
            view.positions.origin_y + block.base_block.y * view.positions.block_size +
                static_cast<double>(block.base_offset.y),
            static_cast<double>(block.base_sample_fraction.z) +
                static_cast<double>(block.base_sample_fraction.w)};
}

inline std::array<double, 3> eye_of(const View& view) {
    std::array<double, 3> eye = base_of(view);
    for (int axis = 0; axis < 3; ++axis)
        eye[static_cast<size_t>(axis)] -=
            static_cast<double>(view.block->forward.w) * static_cast<double>(view.block->forward[axis]);
    return eye;
}

}  // namespace decalgl

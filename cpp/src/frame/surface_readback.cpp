#include "frame/surface_readback.h"

#include <cmath>
#include <cstring>
#include <limits>

namespace decalgl {
namespace {

constexpr uint32_t sky_block = 0x80000000U;
constexpr double radians = 3.14159265358979323846 / 180.0;

double map_coordinate(uint32_t block, uint32_t offset_bits, double origin, double block_size) {
    float offset = 0.0F;
    std::memcpy(&offset, &offset_bits, sizeof(offset));
    return origin + static_cast<double>(static_cast<int32_t>(block)) * block_size +
           static_cast<double>(offset);
}

// The height at a depth along each pixel's ray, in double precision.
class RayHeights {
public:
    RayHeights(const Camera& camera, int width, int height)
        : basis_(basis_of(camera)),
          eye_z_(camera.eye.z),
          width_(width),
          height_(height),
          orthographic_(camera.orthographic()),
          half_(orthographic_ ? 0.5 * camera.view_height : std::tan(0.5 * camera.fov * radians)) {}

    double at(int x, int row, double depth) const {
        const double right = (2.0 * x + 1.0 - width_) / height_ * half_;
        const double up = (height_ - 2.0 * row - 1.0) / height_ * half_;
        const double aside = right * basis_.right.z + up * basis_.up.z;
        return orthographic_ ? eye_z_ + aside + depth * basis_.forward.z
                             : eye_z_ + depth * (basis_.forward.z + aside);
    }

private:
    CameraBasis basis_;
    double eye_z_;
    double width_;
    double height_;
    bool orthographic_;
    double half_;
};

}  // namespace

void unpack_surface(const std::vector<uint32_t>& positions, const std::vector<float>& surfaces,
                    const PictureRequest& request, const PositionGrid& grid, double base_depth,
                    std::vector<double>& world, std::vector<float>& depth, std::vector<float>& gradients) {
    const size_t pixels = positions.size() / 4;
    const RayHeights heights(request.camera, request.width, request.height);
    world.assign(3 * pixels, std::numeric_limits<double>::quiet_NaN());
    depth.assign(pixels, std::numeric_limits<float>::infinity());
    gradients.assign(2 * pixels, 0.0F);
    for (size_t i = 0; i < pixels; ++i) {
        if (positions[4 * i] == sky_block)
            continue;
        const auto x = static_cast<int>(i % static_cast<size_t>(request.width));
        const auto row = static_cast<int>(i / static_cast<size_t>(request.width));
        const double exact = base_depth + static_cast<double>(surfaces[4 * i + 2]);
        depth[i] = static_cast<float>(exact);
        gradients[2 * i] = surfaces[4 * i];
        gradients[2 * i + 1] = surfaces[4 * i + 1];
        world[3 * i] = map_coordinate(positions[4 * i], positions[4 * i + 2], grid.origin_x, grid.block_size);
        world[3 * i + 1] =
            map_coordinate(positions[4 * i + 1], positions[4 * i + 3], grid.origin_y, grid.block_size);
        world[3 * i + 2] = heights.at(x, row, exact);
    }
}

}  // namespace decalgl

#include "technique/distance_field/drop_offs.h"

#include <algorithm>
#include <cmath>

#include "gl/gl.h"

namespace decalgl::network {

std::vector<uint8_t> drop_off_texels(int layer) {
    std::vector<uint8_t> texels;
    texels.reserve(size_t{drop_off_side} * drop_off_side);
    for (int row = 0; row < drop_off_side; ++row) {
        for (int column = 0; column < drop_off_side; ++column) {
            const double u = double(column) / (drop_off_side - 1), v = double(row) / (drop_off_side - 1);
            const double value = layer == 0                                    ? v
                                 : layer == static_cast<int>(CapShape::round)  ? std::hypot(u, v)
                                 : layer == static_cast<int>(CapShape::square) ? std::max(u, v)
                                                                               : 1.0;
            texels.push_back(static_cast<uint8_t>(std::lround(255.0 * std::min(value, 1.0))));
        }
    }
    return texels;
}

gl::Texture2D make_drop_offs(const DistanceFieldOptions& options, const MemoryAccount& memory) {
    const int layers = first_custom_cap + static_cast<int>(options.drop_offs.size());
    gl::Texture2D texture = gl::Texture2D::create_array(memory, "distance_field: drop-offs", GL_R8,
                                                        drop_off_side, drop_off_side, layers);
    for (int layer = 0; layer < first_custom_cap; ++layer)
        texture.update_layer(layer, drop_off_texels(layer).data());
    for (int layer = first_custom_cap; layer < layers; ++layer)
        texture.update_layer(layer, options.drop_offs[static_cast<size_t>(layer - first_custom_cap)].data());
    texture.set_filter(GL_LINEAR, GL_LINEAR);
    return texture;
}

}  // namespace decalgl::network

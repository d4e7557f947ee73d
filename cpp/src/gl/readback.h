#pragma once

// Reading pictures back into memory. Rows come as GL has them, the bottom one first.

#include "gl/texture.h"

#include <vector>

namespace decalgl::gl {

/// Reads a rectangle of one colour attachment (or of the depth, with attachment GL_DEPTH_ATTACHMENT) as
/// tightly packed pixels into `pixels`; waits for the driver. `bytes` is the room there (else
/// Error(graphics)).
void read_pixels(const Framebuffer& framebuffer, GLenum attachment, int x, int y, int width, int height,
                 TransferFormat transfer, std::size_t bytes, void* pixels);

/// The same, as `components` values of T a pixel: width * height * components of them.
template <typename T>
std::vector<T> read_pixels(const Framebuffer& framebuffer, GLenum attachment, int x, int y, int width,
                           int height, TransferFormat transfer, int components) {
    std::vector<T> pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                          static_cast<std::size_t>(components));
    read_pixels(framebuffer, attachment, x, y, width, height, transfer, pixels.size() * sizeof(T),
                pixels.data());
    return pixels;
}

/// Reads one level of a texture in its own transfer format.
void read_texture(const Texture2D& texture, int level, std::size_t bytes, void* texels);

template <typename T>
std::vector<T> read_texture(const Texture2D& texture, int level = 0) {
    const auto side = [level](int size) {
        return static_cast<std::size_t>(size >> level > 0 ? size >> level : 1);
    };
    const std::size_t bytes = side(texture.width()) * side(texture.height()) * texel_bytes(texture.format());
    std::vector<T> texels(bytes / sizeof(T));
    read_texture(texture, level, bytes, texels.data());
    return texels;
}

}  // namespace decalgl::gl

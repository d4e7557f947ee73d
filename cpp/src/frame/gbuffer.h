// The G-buffer: what is seen at each pixel of a rectangle of the picture.
#pragma once

#include "decalgl/technique/technique.h"
#include "gl/texture.h"

namespace decalgl {

class GBuffer {
public:
    GBuffer() = default;
    // samples: a pixel, as the driver draws them; 0: one, in textures that techniques read.
    GBuffer(int width, int height, const MemoryAccount& memory, int samples = 0);

    // Binds it for drawing and clears it to sky.
    void begin() const;
    GBufferView view() const { return {&position, &surface, &depth, nullptr, {}}; }
    int width() const { return position.width(); }
    int height() const { return position.height(); }

    gl::Texture2D position;  // block x, y; offset x, y as bits
    gl::Texture2D surface;   // gradient x, y; distance along the ray, infinite for sky; hillshade
    gl::Texture2D base;      // colour of the bare terrain
    gl::Texture2D depth;     // reversed
    gl::Framebuffer framebuffer;
};

}  // namespace decalgl

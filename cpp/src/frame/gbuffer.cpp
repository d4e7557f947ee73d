#include "frame/gbuffer.h"

#include <limits>

namespace decalgl {

GBuffer::GBuffer(int width, int height, const MemoryAccount& memory)
    : position(gl::Texture2D::create(memory, "frame: position", GL_RGBA32UI, width, height)),
      surface(gl::Texture2D::create(memory, "frame: surface", GL_RGBA32F, width, height)),
      base(gl::Texture2D::create(memory, "frame: base", GL_RGBA8, width, height)),
      depth(gl::Texture2D::create(memory, "frame: depth", GL_DEPTH_COMPONENT32F, width, height)),
      framebuffer(gl::Framebuffer::create("G-buffer", {{GL_COLOR_ATTACHMENT0, &position},
                                                       {GL_COLOR_ATTACHMENT1, &surface},
                                                       {GL_COLOR_ATTACHMENT2, &base},
                                                       {GL_DEPTH_ATTACHMENT, &depth}})) {}

void GBuffer::begin() const {
    constexpr unsigned sky_block = 0x80000000U;  // shaders/shared/position.glsl
    framebuffer.bind();
    framebuffer.clear_color_uint(0, sky_block);
    framebuffer.clear_color(1, 0.0F, 0.0F, std::numeric_limits<float>::infinity(), 1.0F);
    framebuffer.clear_depth(0.0F);
}

}  // namespace decalgl

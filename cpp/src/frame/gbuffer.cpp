#include "frame/gbuffer.h"

#include <limits>

namespace decalgl {

GBuffer::GBuffer(int width, int height, const MemoryAccount& memory, int samples) {
    const auto texture = [&](const char* name, GLenum format) {
        return gl::Texture2D::create(memory, name, format, width, height, 1, samples);
    };
    position = texture("frame: position", GL_RGBA32UI);
    surface = texture("frame: surface", GL_RGBA32F);
    base = texture("frame: base", GL_RGBA8);
    depth = texture("frame: depth", GL_DEPTH_COMPONENT32F);
    framebuffer = gl::Framebuffer::create("G-buffer", {{GL_COLOR_ATTACHMENT0, &position},
                                                       {GL_COLOR_ATTACHMENT1, &surface},
                                                       {GL_COLOR_ATTACHMENT2, &base},
                                                       {GL_DEPTH_ATTACHMENT, &depth}});
}

void GBuffer::begin() const {
    constexpr unsigned sky_block = 0x80000000U;  // shaders/shared/position.glsl
    framebuffer.bind();
    framebuffer.clear_color_uint(0, sky_block);
    framebuffer.clear_color(1, 0.0F, 0.0F, std::numeric_limits<float>::infinity(), 1.0F);
    framebuffer.clear_depth(0.0F);
}

}  // namespace decalgl

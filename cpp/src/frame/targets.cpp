#include "frame/targets.h"

#include <tuple>

namespace decalgl {

SeenTargets::SeenTargets(int width, int height, bool has_overlay, OverlayDepth depth,
                         const MemoryAccount& memory)
    : gbuffer(width, height, memory) {
    if (!has_overlay)
        return;
    overlay = gl::Texture2D::create(memory, "frame: overlay", GL_RGBA8, width, height);
    std::vector<gl::Attachment> attachments{{GL_COLOR_ATTACHMENT0, &overlay}};
    if (depth != OverlayDepth::none) {
        const bool stencil = depth == OverlayDepth::depth_and_stencil;
        overlay_depth = gl::Texture2D::create(
            memory, "frame: overlay", stencil ? GL_DEPTH32F_STENCIL8 : GL_DEPTH_COMPONENT32F, width, height);
        attachments.push_back(
            {stencil ? GLenum{GL_DEPTH_STENCIL_ATTACHMENT} : GLenum{GL_DEPTH_ATTACHMENT}, &overlay_depth});
    }
    overlay_framebuffer = gl::Framebuffer::create("overlay", attachments);
}

bool TargetNeeds::serve(const TargetNeeds& others) const {
    const auto members = [](const TargetNeeds& needs) {
        return std::tie(needs.width, needs.height, needs.antialias, needs.multisamples);
    };
    return members(*this) == members(others) && has_overlay >= others.has_overlay &&
           overlay_depth >= others.overlay_depth;
}

Targets::Targets(const TargetNeeds& needed, const MemoryAccount& memory)
    : needs(needed), seen(needed.width, needed.height, needed.has_overlay, needed.overlay_depth, memory) {
    const auto make = [&](const char* name, GLenum format, gl::Texture2D& texture,
                          gl::Framebuffer& framebuffer) {
        texture =
            gl::Texture2D::create(memory, std::string("frame: ") + name, format, needs.width, needs.height);
        framebuffer = gl::Framebuffer::create(name, {{GL_COLOR_ATTACHMENT0, &texture}});
    };
    if (needs.antialias == Antialias::ssaa || needs.antialias == Antialias::msaa)
        make("sum", GL_RGBA32F, sum, sum_framebuffer);
    if (needs.multisamples > 0)
        multisampled = GBuffer(needs.width, needs.height, memory, needs.multisamples);
    if (needs.antialias == Antialias::fxaa)
        make("composed", GL_RGBA8, composed, composed_framebuffer);
    make("picture", GL_RGBA8, picture, picture_framebuffer);
}

}  // namespace decalgl

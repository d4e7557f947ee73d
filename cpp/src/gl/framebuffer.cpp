#include "decalgl/core/error.h"
#include "gl/context.h"
#include "gl/texture.h"

#include <algorithm>

#include <fmt/format.h>

namespace decalgl::gl {
namespace {

std::string status_name(GLenum status) {
    switch (status) {
        case GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT:
            return "an attachment cannot be drawn into";
        case GL_FRAMEBUFFER_INCOMPLETE_MISSING_ATTACHMENT:
            return "there is no attachment";
        case GL_FRAMEBUFFER_INCOMPLETE_MULTISAMPLE:
            return "the attachments differ in their number of samples";
        case GL_FRAMEBUFFER_UNSUPPORTED:
            return "the driver does not support this combination of formats";
        default:
            return fmt::format("status 0x{:04x}", status);
    }
}

bool is_color(GLenum point) {
    return point >= GL_COLOR_ATTACHMENT0 && point < GL_COLOR_ATTACHMENT0 + 8;
}

/// Draw buffer i is colour attachment i, or none where that is missing.
void set_draw_buffers(GLuint id, const std::vector<Attachment>& attachments) {
    std::vector<GLenum> buffers;
    for (const Attachment& attachment : attachments) {
        if (is_color(attachment.point)) {
            const std::size_t index = attachment.point - GL_COLOR_ATTACHMENT0;
            buffers.resize(std::max(buffers.size(), index + 1), GL_NONE);
            buffers[index] = attachment.point;
        }
    }
    if (buffers.empty()) {
        glNamedFramebufferDrawBuffer(id, GL_NONE);
        glNamedFramebufferReadBuffer(id, GL_NONE);
    } else {
        glNamedFramebufferDrawBuffers(id, static_cast<GLsizei>(buffers.size()), buffers.data());
    }
}

void check_complete(GLuint id, const std::string& name, const std::vector<Attachment>& attachments) {
    const GLenum status = glCheckNamedFramebufferStatus(id, GL_FRAMEBUFFER);
    if (status == GL_FRAMEBUFFER_COMPLETE) {
        return;
    }
    std::string list;
    for (const Attachment& attachment : attachments) {
        list += fmt::format(" [point 0x{:04x}: format 0x{:04x}, {} x {}]", attachment.point,
                            attachment.texture->format(), attachment.texture->width(),
                            attachment.texture->height());
    }
    throw Error(ErrorKind::graphics,
                fmt::format("The framebuffer {} is not complete: {}.{}", name, status_name(status), list));
}

}  // namespace

Framebuffer Framebuffer::create(const std::string& name, std::initializer_list<Attachment> attachments) {
    return create(name, std::vector<Attachment>(attachments));
}

Framebuffer Framebuffer::create(const std::string& name, const std::vector<Attachment>& attachments) {
    Framebuffer framebuffer;
    GLuint id = 0;
    glCreateFramebuffers(1, &id);
    framebuffer.handle_ = ObjectHandle(ObjectType::framebuffer, id);
    for (const Attachment& attachment : attachments) {
        glNamedFramebufferTexture(id, attachment.point, attachment.texture->id(), attachment.level);
        const int width = std::max(1, attachment.texture->width() >> attachment.level);
        const int height = std::max(1, attachment.texture->height() >> attachment.level);
        const bool first = framebuffer.width_ == 0;
        framebuffer.width_ = first ? width : std::min(framebuffer.width_, width);
        framebuffer.height_ = first ? height : std::min(framebuffer.height_, height);
    }
    set_draw_buffers(id, attachments);
    check_complete(id, name, attachments);
    check_errors(fmt::format("creating the framebuffer {}", name).c_str());
    return framebuffer;
}

void Framebuffer::bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, id());
    glViewport(0, 0, width_, height_);
}

void Framebuffer::clear_color(int index, float red, float green, float blue, float alpha) const {
    const GLfloat value[] = {red, green, blue, alpha};
    glClearNamedFramebufferfv(id(), GL_COLOR, index, value);
}

void Framebuffer::clear_color_int(int index, int red, int green, int blue, int alpha) const {
    const GLint value[] = {red, green, blue, alpha};
    glClearNamedFramebufferiv(id(), GL_COLOR, index, value);
}

void Framebuffer::clear_color_uint(int index, unsigned red, unsigned green, unsigned blue,
                                   unsigned alpha) const {
    const GLuint value[] = {red, green, blue, alpha};
    glClearNamedFramebufferuiv(id(), GL_COLOR, index, value);
}

void Framebuffer::clear_depth(float depth) const {
    glClearNamedFramebufferfv(id(), GL_DEPTH, 0, &depth);
}

void Framebuffer::clear_stencil(int stencil) const {
    glClearNamedFramebufferiv(id(), GL_STENCIL, 0, &stencil);
}

void Framebuffer::clear_depth_stencil(float depth, int stencil) const {
    glClearNamedFramebufferfi(id(), GL_DEPTH_STENCIL, 0, depth, stencil);
}

void Framebuffer::blit_to(const Framebuffer& target, GLbitfield mask) const {
    const int width = std::min(width_, target.width_);
    const int height = std::min(height_, target.height_);
    glBlitNamedFramebuffer(id(), target.id(), 0, 0, width, height, 0, 0, width, height, mask, GL_NEAREST);
}

}  // namespace decalgl::gl

#include "gl/readback.h"

#include "decalgl/core/error.h"
#include "gl/context.h"

#include <climits>

#include <fmt/format.h>

namespace decalgl::gl {
namespace {

GLsizei transfer_size(std::size_t bytes) {
    // The robust read functions count in int.
    return static_cast<GLsizei>(bytes > INT_MAX ? INT_MAX : bytes);
}

}  // namespace

void read_pixels(const Framebuffer& framebuffer, GLenum attachment, int x, int y, int width, int height,
                 TransferFormat transfer, std::size_t bytes, void* pixels) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer.id());
    if (attachment >= GL_COLOR_ATTACHMENT0 && attachment < GL_COLOR_ATTACHMENT0 + 8) {
        glReadBuffer(attachment);
    }
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    if (bytes > INT_MAX) {
        glReadPixels(x, y, width, height, transfer.format, transfer.type, pixels);
    } else {
        glReadnPixels(x, y, width, height, transfer.format, transfer.type, transfer_size(bytes), pixels);
    }
    check_errors("reading pixels back");
}

void read_texture(const Texture2D& texture, int level, std::size_t bytes, void* texels) {
    const TransferFormat transfer = transfer_format(texture.format());
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTextureImage(texture.id(), level, transfer.format, transfer.type, transfer_size(bytes), texels);
    check_errors("reading a texture back");
}

}  // namespace decalgl::gl

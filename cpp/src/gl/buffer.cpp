#include "gl/buffer.h"

#include "decalgl/core/error.h"
#include "gl/context.h"
#include "gl/texture.h"

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>

namespace decalgl::gl {

Buffer Buffer::create(const MemoryAccount& account, const std::string& name, std::size_t bytes,
                      const void* data, GLbitfield flags) {
    // GL has no storage of zero bytes; a word keeps empty layers free of special cases.
    const std::size_t stored = std::max<std::size_t>(bytes, 4);
    if (stored > static_cast<std::size_t>(PTRDIFF_MAX)) {
        throw Error(ErrorKind::memory,
                    fmt::format("{} needs a buffer of {} bytes, which cannot exist.", name, bytes));
    }
    Buffer buffer;
    buffer.charge_ = MemoryCharge(account, name, stored);
    GLuint id = 0;
    glCreateBuffers(1, &id);
    buffer.handle_ = ObjectHandle(ObjectType::buffer, id);
    buffer.bytes_ = bytes;
    glNamedBufferStorage(id, static_cast<GLsizeiptr>(stored), bytes == 0 ? nullptr : data, flags);
    if (data != nullptr)
        Context::require_current().uploads().add(bytes);
    check_errors(fmt::format("creating the buffer {} of {}", name, format_bytes(bytes)).c_str());
    return buffer;
}

void Buffer::update(std::size_t offset, std::size_t bytes, const void* data) {
    if (bytes > bytes_ || offset > bytes_ - bytes) {
        throw Error(ErrorKind::graphics,
                    fmt::format("An update of bytes {} to {} leaves a buffer of {} bytes.", offset,
                                offset + bytes, bytes_));
    }
    if (bytes != 0) {
        glNamedBufferSubData(id(), static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
        Context::require_current().uploads().add(bytes);
    }
}

void Buffer::clear() {
    glClearNamedBufferData(id(), GL_R8UI, GL_RED_INTEGER, GL_UNSIGNED_BYTE, nullptr);
}

void Buffer::bind_base(GLenum target, GLuint index) const {
    glBindBufferBase(target, index, id());
}

void Buffer::read(std::size_t offset, std::size_t bytes, void* data) const {
    if (bytes > bytes_ || offset > bytes_ - bytes) {
        throw Error(ErrorKind::graphics, fmt::format("Reading bytes {} to {} leaves a buffer of {} bytes.",
                                                     offset, offset + bytes, bytes_));
    }
    if (bytes != 0) {
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        glGetNamedBufferSubData(id(), static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
    }
}

TextureBuffer TextureBuffer::create(const MemoryAccount& account, const std::string& name, GLenum format,
                                    std::size_t bytes, const void* data, GLbitfield flags) {
    const std::size_t texel = texel_bytes(format);
    const auto limit = static_cast<std::size_t>(Context::require_current().info().max_texture_buffer_size);
    if (bytes / texel > limit) {
        throw Error(
            ErrorKind::memory,
            fmt::format("{} has {} texels, but this driver reads at most {} from one texture buffer. Draw "
                        "fewer features, or split the layer.",
                        name, bytes / texel, limit));
    }
    TextureBuffer texture;
    // A view needs at least one whole texel.
    if (bytes == 0) {
        const std::vector<unsigned char> zeros(texel, 0);
        texture.buffer_ = Buffer::create(account, name, texel, zeros.data(), flags);
    } else {
        texture.buffer_ = Buffer::create(account, name, bytes, data, flags);
    }
    texture.texels_ = bytes / texel;
    GLuint id = 0;
    glCreateTextures(GL_TEXTURE_BUFFER, 1, &id);
    texture.view_ = ObjectHandle(ObjectType::texture, id);
    glTextureBuffer(id, format, texture.buffer_.id());
    check_errors(fmt::format("creating the texture buffer {}", name).c_str());
    return texture;
}

void TextureBuffer::bind(GLuint unit) const {
    glBindTextureUnit(unit, id());
}

}  // namespace decalgl::gl

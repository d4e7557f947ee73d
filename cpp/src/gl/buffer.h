#pragma once

// Buffers of immutable storage, and texture buffers: the way large static arrays reach the shaders.

#include "decalgl/core/memory.h"
#include "decalgl/core/span.h"
#include "gl/object.h"

#include <cstddef>
#include <string>
#include <vector>

namespace decalgl::gl {

class Buffer {
public:
    Buffer() = default;

    /// Storage of `bytes` bytes, counted under `name`. `data` may be null. `flags` as glNamedBufferStorage
    /// takes them, e.g. GL_DYNAMIC_STORAGE_BIT for update(). Zero bytes make a buffer of one unused word.
    /// Throws Error(memory) where the account or the driver has no room.
    static Buffer create(const MemoryAccount& account, const std::string& name, std::size_t bytes,
                         const void* data = nullptr, GLbitfield flags = 0);

    template <typename T>
    static Buffer from(const MemoryAccount& account, const std::string& name, Span<T> values,
                       GLbitfield flags = 0) {
        return create(account, name, values.size_bytes(), values.data(), flags);
    }
    template <typename T>
    static Buffer from(const MemoryAccount& account, const std::string& name, const std::vector<T>& values,
                       GLbitfield flags = 0) {
        return create(account, name, values.size() * sizeof(T), values.data(), flags);
    }

    /// Replaces [offset, offset + bytes); the buffer was made with GL_DYNAMIC_STORAGE_BIT.
    void update(std::size_t offset, std::size_t bytes, const void* data);
    template <typename T>
    void update(const std::vector<T>& values) {
        update(0, values.size() * sizeof(T), values.data());
    }

    /// Sets every byte to zero, on the GPU.
    void clear();

    /// glBindBufferBase; target is GL_UNIFORM_BUFFER, GL_SHADER_STORAGE_BUFFER, ...
    void bind_base(GLenum target, GLuint index) const;

    void read(std::size_t offset, std::size_t bytes, void* data) const;
    /// The whole buffer read back as values; waits for the driver.
    template <typename T>
    std::vector<T> read() const {
        std::vector<T> values(bytes_ / sizeof(T));
        read(0, values.size() * sizeof(T), values.data());
        return values;
    }

    GLuint id() const { return handle_.name(); }
    std::size_t bytes() const { return bytes_; }
    explicit operator bool() const { return static_cast<bool>(handle_); }

private:
    ObjectHandle handle_;
    MemoryCharge charge_;
    std::size_t bytes_ = 0;
};

/// A buffer read in shaders as samplerBuffer, usamplerBuffer or isamplerBuffer.
class TextureBuffer {
public:
    TextureBuffer() = default;

    /// `format` is a sized format of texture buffers (GL_RGBA16UI, GL_RG32UI, GL_R32F, ...); `bytes` is a
    /// multiple of its texel. Throws Error(memory) where there are more texels than the driver can address.
    static TextureBuffer create(const MemoryAccount& account, const std::string& name, GLenum format,
                                std::size_t bytes, const void* data = nullptr, GLbitfield flags = 0);

    template <typename T>
    static TextureBuffer from(const MemoryAccount& account, const std::string& name, GLenum format,
                              Span<T> values, GLbitfield flags = 0) {
        return create(account, name, format, values.size_bytes(), values.data(), flags);
    }
    template <typename T>
    static TextureBuffer from(const MemoryAccount& account, const std::string& name, GLenum format,
                              const std::vector<T>& values, GLbitfield flags = 0) {
        return create(account, name, format, values.size() * sizeof(T), values.data(), flags);
    }

    /// Binds the view to a texture unit.
    void bind(GLuint unit) const;

    const Buffer& buffer() const { return buffer_; }
    Buffer& buffer() { return buffer_; }
    GLuint id() const { return view_.name(); }
    std::size_t texels() const { return texels_; }
    explicit operator bool() const { return static_cast<bool>(view_); }

private:
    Buffer buffer_;
    ObjectHandle view_;
    std::size_t texels_ = 0;
};

}  // namespace decalgl::gl

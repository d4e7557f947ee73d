#pragma once

// Two-dimensional textures of immutable storage, and framebuffers made of them.

#include "decalgl/core/memory.h"
#include "gl/object.h"

#include <initializer_list>
#include <string>
#include <vector>

namespace decalgl::gl {

/// Bytes a texel of a sized format takes; Error(graphics) for a format this library does not use.
std::size_t texel_bytes(GLenum format);

/// The transfer format and type that read or write a sized format without conversion
/// (GL_RGBA8 -> GL_RGBA, GL_UNSIGNED_BYTE; GL_R32I -> GL_RED_INTEGER, GL_INT; ...).
struct TransferFormat {
    GLenum format = 0;
    GLenum type = 0;
};
TransferFormat transfer_format(GLenum format);

class Texture2D {
public:
    Texture2D() = default;

    /// Storage in a sized format, counted under `name`; nearest filtering, clamped to the edge.
    /// `samples` above 0 makes a multisample texture. Throws Error(memory) where a side is larger than the
    /// driver's limit, or the account or the driver has no room; Error(input) for a side below 1.
    static Texture2D create(const MemoryAccount& account, const std::string& name, GLenum format, int width,
                            int height, int levels = 1, int samples = 0);

    /// An array of layers of one size, each of one level. Attached to a framebuffer, geometry shaders choose
    /// the layer. Throws as create() does, and Error(memory) for more layers than the driver has.
    static Texture2D create_array(const MemoryAccount& account, const std::string& name, GLenum format,
                                  int width, int height, int layers);

    /// Writes a whole layer of an array.
    void update_layer(int layer, const void* texels);
    /// Writes a rectangle from tightly packed texels of transfer_format(format()).
    void update(int level, int x, int y, int width, int height, const void* texels);
    void set_filter(GLenum minify, GLenum magnify);
    void set_wrap(GLenum wrap_s, GLenum wrap_t);

    void bind(GLuint unit) const;
    /// For imageLoad and imageStore; access is GL_READ_ONLY, GL_WRITE_ONLY or GL_READ_WRITE.
    void bind_image(GLuint unit, GLenum access, int level = 0) const;

    GLuint id() const { return handle_.name(); }
    GLenum target() const {
        return layers_ > 0 ? GL_TEXTURE_2D_ARRAY : samples_ > 0 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D;
    }
    GLenum format() const { return format_; }
    int width() const { return width_; }
    int height() const { return height_; }
    int levels() const { return levels_; }
    int samples() const { return samples_; }
    int layers() const { return layers_; }  ///< of an array; else 0
    std::size_t bytes() const { return static_cast<std::size_t>(charge_.bytes()); }
    explicit operator bool() const { return static_cast<bool>(handle_); }

private:
    ObjectHandle handle_;
    MemoryCharge charge_;
    GLenum format_ = 0;
    int width_ = 0;
    int height_ = 0;
    int levels_ = 0;
    int samples_ = 0;
    int layers_ = 0;
};

/// What a framebuffer draws into; the textures must outlive it.
struct Attachment {
    GLenum point = 0;  ///< GL_COLOR_ATTACHMENT0 + i, GL_DEPTH_ATTACHMENT, GL_DEPTH_STENCIL_ATTACHMENT
    const Texture2D* texture = nullptr;
    int level = 0;
};

class Framebuffer {
public:
    Framebuffer() = default;

    /// Colour attachments become the draw buffers of the same index. Throws Error(graphics), which names
    /// the reason and the attachments, where the result is not complete.
    static Framebuffer create(const std::string& name, std::initializer_list<Attachment> attachments);
    static Framebuffer create(const std::string& name, const std::vector<Attachment>& attachments);

    /// Draws go here, and the viewport is the whole of it.
    void bind() const;

    /// Clears the colour attachment `index`.
    void clear_color(int index, float red, float green, float blue, float alpha) const;
    void clear_color_int(int index, int red, int green = 0, int blue = 0, int alpha = 0) const;
    void clear_color_uint(int index, unsigned red, unsigned green = 0, unsigned blue = 0,
                          unsigned alpha = 0) const;
    void clear_depth(float depth) const;
    void clear_stencil(int stencil) const;
    void clear_depth_stencil(float depth, int stencil) const;

    /// Copies a rectangle of the same place; `mask` of GL_COLOR_BUFFER_BIT and so on, nearest filtering.
    void blit_to(const Framebuffer& target, GLbitfield mask) const;

    GLuint id() const { return handle_.name(); }
    int width() const { return width_; }
    int height() const { return height_; }
    explicit operator bool() const { return static_cast<bool>(handle_); }

private:
    ObjectHandle handle_;
    int width_ = 0;
    int height_ = 0;
};

}  // namespace decalgl::gl

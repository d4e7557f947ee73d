#pragma once

// Vertex arrays. Buffers must outlive the array.

#include "gl/buffer.h"

namespace decalgl::gl {

/// One attribute of a vertex.
struct Attribute {
    GLuint location = 0;
    GLint components = 0;
    GLenum type = GL_FLOAT;
    GLuint offset = 0;        ///< bytes from the start of the vertex
    bool integer = false;     ///< read as an integer in the shader
    bool normalized = false;  ///< integers scaled to 0..1 or -1..1
};

class VertexArray {
public:
    VertexArray() = default;

    /// An array without attributes serves full-screen passes, which make their vertices from gl_VertexID.
    static VertexArray create();

    /// Attributes read from `buffer` through binding point `binding`; `divisor` 1 steps once an instance.
    void set_vertices(GLuint binding, const Buffer& buffer, GLsizei stride,
                      const std::vector<Attribute>& attributes, GLintptr offset = 0, GLuint divisor = 0);
    void set_elements(const Buffer& buffer);

    void bind() const;

    GLuint id() const { return handle_.name(); }
    explicit operator bool() const { return static_cast<bool>(handle_); }

private:
    ObjectHandle handle_;
};

}  // namespace decalgl::gl

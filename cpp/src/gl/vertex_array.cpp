#include "gl/vertex_array.h"

namespace decalgl::gl {

VertexArray VertexArray::create() {
    VertexArray array;
    GLuint id = 0;
    glCreateVertexArrays(1, &id);
    array.handle_ = ObjectHandle(ObjectType::vertex_array, id);
    return array;
}

void VertexArray::set_vertices(GLuint binding, const Buffer& buffer, GLsizei stride,
                               const std::vector<Attribute>& attributes, GLintptr offset, GLuint divisor) {
    glVertexArrayVertexBuffer(id(), binding, buffer.id(), offset, stride);
    glVertexArrayBindingDivisor(id(), binding, divisor);
    for (const Attribute& attribute : attributes) {
        glEnableVertexArrayAttrib(id(), attribute.location);
        if (attribute.integer) {
            glVertexArrayAttribIFormat(id(), attribute.location, attribute.components, attribute.type,
                                       attribute.offset);
        } else {
            glVertexArrayAttribFormat(id(), attribute.location, attribute.components, attribute.type,
                                      attribute.normalized ? GL_TRUE : GL_FALSE, attribute.offset);
        }
        glVertexArrayAttribBinding(id(), attribute.location, binding);
    }
}

void VertexArray::set_elements(const Buffer& buffer) {
    glVertexArrayElementBuffer(id(), buffer.id());
}

void VertexArray::bind() const {
    glBindVertexArray(id());
}

}  // namespace decalgl::gl

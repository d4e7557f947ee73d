#pragma once

// A GL object's name with its owner: moved, never copied, and deleted in its own context.

#include "gl/gl.h"

#include <memory>
#include <utility>

namespace decalgl::gl {

struct ContextState;

enum class ObjectType { buffer, texture, framebuffer, vertex_array, program, query };

/// Dropping a handle deletes the object at once where its context is current, at the context's next
/// make_current() where it is not, and does nothing where the context is gone (the object went with it).
class ObjectHandle {
public:
    ObjectHandle() = default;
    /// Takes over a name just made in the current context.
    ObjectHandle(ObjectType type, GLuint name);
    ObjectHandle(ObjectHandle&& other) noexcept
        : type_(other.type_), name_(std::exchange(other.name_, 0)), context_(std::move(other.context_)) {}
    ObjectHandle& operator=(ObjectHandle&& other) noexcept;
    ObjectHandle(const ObjectHandle&) = delete;
    ObjectHandle& operator=(const ObjectHandle&) = delete;
    ~ObjectHandle() { reset(); }

    GLuint name() const { return name_; }
    explicit operator bool() const { return name_ != 0; }
    void reset() noexcept;

private:
    ObjectType type_ = ObjectType::buffer;
    GLuint name_ = 0;
    std::weak_ptr<ContextState> context_;
};

}  // namespace decalgl::gl

#include "gl/object.h"

#include "gl/context.h"
#include "gl/context_state.h"

#include <mutex>

namespace decalgl::gl {

ObjectHandle::ObjectHandle(ObjectType type, GLuint name)
    : type_(type), name_(name), context_(Context::require_current().state()) {}

ObjectHandle& ObjectHandle::operator=(ObjectHandle&& other) noexcept {
    if (this != &other) {
        reset();
        type_ = other.type_;
        name_ = std::exchange(other.name_, 0);
        context_ = std::move(other.context_);
    }
    return *this;
}

void ObjectHandle::reset() noexcept {
    const GLuint name = std::exchange(name_, 0);
    const std::shared_ptr<ContextState> state = context_.lock();
    context_.reset();
    if (name == 0 || state == nullptr) {
        return;
    }
    const Context* current = Context::current();
    if (current != nullptr && current->state() == state) {
        delete_object(type_, name);
        return;
    }
    const std::lock_guard<std::mutex> lock(state->mutex);
    if (state->context != nullptr) {
        try {
            state->dropped.emplace_back(type_, name);
        } catch (...) {
            // Without memory for the note, the object lives as long as its context.
        }
    }
}

void delete_object(ObjectType type, GLuint name) noexcept {
    switch (type) {
        case ObjectType::buffer:
            glDeleteBuffers(1, &name);
            break;
        case ObjectType::texture:
            glDeleteTextures(1, &name);
            break;
        case ObjectType::framebuffer:
            glDeleteFramebuffers(1, &name);
            break;
        case ObjectType::vertex_array:
            glDeleteVertexArrays(1, &name);
            break;
        case ObjectType::program:
            glDeleteProgram(name);
            break;
        case ObjectType::query:
            glDeleteQueries(1, &name);
            break;
    }
}

}  // namespace decalgl::gl

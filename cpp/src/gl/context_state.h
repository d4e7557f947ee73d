#pragma once

// What outlives a context: object handles and the driver's debug callback refer to it.

#include "gl/object.h"

#include <atomic>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace decalgl::gl {

class Context;

struct ContextState {
    std::mutex mutex;
    Context* context = nullptr;        ///< null once the context is gone
    std::atomic<bool> current{false};  ///< on some thread
    bool debug = false;
    std::vector<std::pair<ObjectType, GLuint>> dropped;  ///< to delete at the next make_current
    std::vector<std::string> messages;                   ///< errors the driver reported since the last check
};

/// Deletes an object of the current context.
void delete_object(ObjectType type, GLuint name) noexcept;

}  // namespace decalgl::gl

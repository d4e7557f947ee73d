#pragma once

// The context that GL tests share, with the driver's errors as exceptions.

#include "decalgl/core/error.h"
#include "decalgl/core/memory.h"
#include "gl/context.h"

#include <memory>

namespace decalgl::test {

/// The process's test context, made current.
inline gl::Context& test_context() {
    static const std::unique_ptr<gl::Context> context = gl::Context::create(gl::Backend::automatic, true);
    context->make_current();
    return *context;
}

}  // namespace decalgl::test

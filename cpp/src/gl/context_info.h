#pragma once

// Reading what a context can do.

#include "gl/context.h"
#include "gl/gl.h"

#include <string>

namespace decalgl::gl {

/// Reads the current context. Throws Error(graphics) where it is older than OpenGL 4.5.
ContextInfo read_context_info(Backend backend, const std::string& platform);

/// "GL_INVALID_VALUE" for a code of glGetError.
std::string error_name(GLenum code);

}  // namespace decalgl::gl

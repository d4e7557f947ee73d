#pragma once

// The ways to a context, one entry a platform. Nothing is opened before `open` is called.

#include "gl/context.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace decalgl::gl {

struct Platform {
    Backend backend = Backend::automatic;
    std::string name;
    std::string cure;  ///< what may help where open() fails
    /// Opens a context, not yet current; throws Error(graphics) with the reason.
    std::function<std::unique_ptr<Context>(bool debug)> open;
};

/// Hardware devices first, then Mesa's surfaceless platform, then software devices. Where libEGL cannot be
/// loaded, one entry whose open() says so.
std::vector<Platform> egl_platforms();
std::vector<Platform> osmesa_platforms();

}  // namespace decalgl::gl

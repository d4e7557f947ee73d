// What kind of Error an action throws.
#pragma once

#include <functional>
#include <stdexcept>

#include "decalgl/core/error.h"

namespace decalgl::test {

inline ErrorKind kind_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        return error.kind();
    }
    throw std::logic_error("no Error was thrown");
}

}  // namespace decalgl::test

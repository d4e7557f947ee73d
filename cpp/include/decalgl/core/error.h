#pragma once

// The one exception type of the C++ side. Its kind decides which Python exception it becomes.

#include <stdexcept>
#include <string>

namespace decalgl {

enum class ErrorKind {
    input,        ///< a value, array or geometry the caller gave is wrong
    crs,          ///< coordinate reference systems are missing or do not fit together
    style,        ///< a colour, width or other styling value is wrong
    file,         ///< a file cannot be read or written
    memory,       ///< a budget, a driver limit or the machine's memory is exceeded
    graphics,     ///< no usable OpenGL, or a driver error
    cancelled,    ///< the progress callback asked to stop
    unsupported,  ///< named in the interface, but not drawn by this version
};

/// The kind's name as written in the enumeration, for logs and tests.
const char* to_string(ErrorKind kind);

/// An error with a message made of complete sentences: what is wrong, where, and what to do.
class Error : public std::runtime_error {
public:
    Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}

    ErrorKind kind() const noexcept { return kind_; }

private:
    ErrorKind kind_;
};

}  // namespace decalgl

#include "decalgl/core/error.h"

namespace decalgl {

const char* to_string(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::input:
            return "input";
        case ErrorKind::crs:
            return "crs";
        case ErrorKind::style:
            return "style";
        case ErrorKind::file:
            return "file";
        case ErrorKind::memory:
            return "memory";
        case ErrorKind::graphics:
            return "graphics";
        case ErrorKind::cancelled:
            return "cancelled";
        case ErrorKind::unsupported:
            return "unsupported";
    }
    return "unknown";
}

}  // namespace decalgl

// Errors of the core become the exceptions of decalgl.errors.
#include <cctype>
#include <new>
#include <stdexcept>
#include <string>

#include "decalgl/core/error.h"
#include "register.h"

namespace py = pybind11;

namespace decalgl::bindings {
namespace {

const char* exception_name(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::input:
            return "InputError";
        case ErrorKind::crs:
            return "CrsError";
        case ErrorKind::style:
            return "StyleError";
        case ErrorKind::file:
            return "FileError";
        case ErrorKind::memory:
            return "MemoryLimitError";
        case ErrorKind::graphics:
            return "GraphicsError";
        case ErrorKind::cancelled:
            return "CancelledError";
        case ErrorKind::unsupported:
            return "UnsupportedError";
    }
    return "DecalError";
}

// The core's messages are clauses; users read sentences.
std::string sentence(std::string text) {
    if (!text.empty())
        text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
    if (!text.empty() && text.back() != '.')
        text += '.';
    return text;
}

void raise(const char* name, const char* message) {
    const py::object type = py::module_::import("decalgl.errors").attr(name);
    // A message may name a file, and the system's names are not always text.
    const std::string text = sentence(message);
    const auto decoded = py::reinterpret_steal<py::object>(
        PyUnicode_DecodeUTF8(text.data(), static_cast<py::ssize_t>(text.size()), "replace"));
    PyErr_SetObject(type.ptr(), decoded.ptr());
}

}  // namespace

void register_errors(py::module_&) {
    py::register_exception_translator([](std::exception_ptr pending) {
        try {
            if (pending)
                std::rethrow_exception(pending);
        } catch (const Error& error) {
            raise(exception_name(error.kind()), error.what());
        } catch (const std::length_error&) {
            raise("MemoryLimitError", "this would be larger than memory can hold; draw less at once");
        } catch (const std::bad_alloc&) {
            raise("MemoryLimitError",
                  "the machine has no memory left for this; draw less at once, or set memory_limit");
        }
    });
}

}  // namespace decalgl::bindings

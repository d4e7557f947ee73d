// Contexts through OSMesa, Mesa's off-screen library, which newer Mesa no longer has: the second choice.

#include "decalgl/core/error.h"
#include "gl/backends.h"
#include "gl/gl.h"

#include <dlfcn.h>

#include <array>

#include <fmt/format.h>

namespace decalgl::gl {
namespace {

const char* const osmesa_cure = "apt-get install libosmesa6";

// From Mesa's GL/osmesa.h, which need not be installed.
constexpr int osmesa_format = 0x22;
constexpr int osmesa_depth_bits = 0x30;
constexpr int osmesa_stencil_bits = 0x31;
constexpr int osmesa_profile = 0x33;
constexpr int osmesa_core_profile = 0x34;
constexpr int osmesa_major_version = 0x36;
constexpr int osmesa_minor_version = 0x37;

using NativeContext = struct osmesa_context*;

struct Osmesa {
    NativeContext (*create_context)(const int* attributes, NativeContext share) = nullptr;
    void (*destroy_context)(NativeContext context) = nullptr;
    GLboolean (*make_current)(NativeContext context, void* buffer, GLenum type, GLsizei width,
                              GLsizei height) = nullptr;
    void* (*get_proc_address)(const char* name) = nullptr;
    std::string failure;
};

template <typename Function>
bool look_up(void* library, const char* name, Function& function) {
    function = reinterpret_cast<Function>(dlsym(library, name));
    return function != nullptr;
}

Osmesa load_osmesa() {
    Osmesa osmesa;
    void* library = dlopen("libOSMesa.so.8", RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) {
        library = dlopen("libOSMesa.so.6", RTLD_NOW | RTLD_LOCAL);
    }
    if (library == nullptr) {
        osmesa.failure = fmt::format("libOSMesa.so.8 cannot be loaded ({}); {}", dlerror(), osmesa_cure);
        return osmesa;
    }
    const bool complete = look_up(library, "OSMesaCreateContextAttribs", osmesa.create_context) &&
                          look_up(library, "OSMesaDestroyContext", osmesa.destroy_context) &&
                          look_up(library, "OSMesaMakeCurrent", osmesa.make_current) &&
                          look_up(library, "OSMesaGetProcAddress", osmesa.get_proc_address);
    if (!complete) {
        osmesa.failure = "libOSMesa is older than Mesa 12 and has no core profile";
    }
    return osmesa;
}

const Osmesa& osmesa_functions() {
    static const Osmesa osmesa = load_osmesa();
    return osmesa;
}

class OsmesaContext final : public Context {
public:
    OsmesaContext() {
        for (const int minor : {6, 5}) {
            const int attributes[] = {osmesa_format,
                                      GL_RGBA,
                                      osmesa_depth_bits,
                                      0,
                                      osmesa_stencil_bits,
                                      0,
                                      osmesa_profile,
                                      osmesa_core_profile,
                                      osmesa_major_version,
                                      4,
                                      osmesa_minor_version,
                                      minor,
                                      0};
            context_ = osmesa_functions().create_context(attributes, nullptr);
            if (context_ != nullptr) {
                return;
            }
        }
        throw Error(ErrorKind::graphics, "OSMesa gives no OpenGL 4.5 core context");
    }

    ~OsmesaContext() override {
        shut_down();
        osmesa_functions().destroy_context(context_);
    }

protected:
    void bind() override {
        if (osmesa_functions().make_current(context_, pixel_.data(), GL_UNSIGNED_BYTE, 1, 1) != GL_TRUE) {
            throw Error(ErrorKind::graphics, "OSMesaMakeCurrent failed");
        }
    }

    void unbind() noexcept override { osmesa_functions().make_current(nullptr, nullptr, 0, 0, 0); }

    void* get_proc(const char* name) const override { return osmesa_functions().get_proc_address(name); }

    Backend backend() const override { return Backend::osmesa; }

private:
    NativeContext context_ = nullptr;
    /// OSMesa wants a buffer for the window it does not have; everything is drawn into framebuffer objects.
    alignas(64) std::array<unsigned char, 64> pixel_{};
};

}  // namespace

std::vector<Platform> osmesa_platforms() {
    return {{Backend::osmesa, "OSMesa", osmesa_cure, [](bool) -> std::unique_ptr<Context> {
                 if (!osmesa_functions().failure.empty()) {
                     throw Error(ErrorKind::graphics, osmesa_functions().failure);
                 }
                 return std::make_unique<OsmesaContext>();
             }}};
}

}  // namespace decalgl::gl

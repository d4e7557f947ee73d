// Contexts through EGL without any window or surface.
//
// libEGL is opened at run time and never closed, and displays are never terminated: another library of the
// process may use the same ones.

#include "decalgl/core/error.h"
#include "gl/backends.h"

// The types and constants alone; the functions below are looked up by name.
#include <glad/egl.h>

#include <dlfcn.h>

#include <cstring>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#ifndef EGL_PLATFORM_SURFACELESS_MESA
#define EGL_PLATFORM_SURFACELESS_MESA 0x31DD
#endif

namespace decalgl::gl {
namespace {

const char* const egl_cure = "apt-get install libegl1 libgl1-mesa-dri";

/// The functions of libEGL that are used here.
struct Egl {
    PFNEGLGETPROCADDRESSPROC get_proc_address = nullptr;
    PFNEGLGETERRORPROC get_error = nullptr;
    PFNEGLQUERYSTRINGPROC query_string = nullptr;
    PFNEGLINITIALIZEPROC initialize = nullptr;
    PFNEGLBINDAPIPROC bind_api = nullptr;
    PFNEGLCHOOSECONFIGPROC choose_config = nullptr;
    PFNEGLCREATECONTEXTPROC create_context = nullptr;
    PFNEGLDESTROYCONTEXTPROC destroy_context = nullptr;
    PFNEGLMAKECURRENTPROC make_current = nullptr;
    PFNEGLGETPLATFORMDISPLAYEXTPROC get_platform_display = nullptr;
    PFNEGLQUERYDEVICESEXTPROC query_devices = nullptr;             ///< null where there is no enumeration
    PFNEGLQUERYDEVICESTRINGEXTPROC query_device_string = nullptr;  ///< null where there is no enumeration
    std::string failure;                                           ///< why there is no EGL, or empty
};

template <typename Function>
bool look_up(void* library, const Egl& egl, const char* name, Function& function) {
    void* symbol = dlsym(library, name);
    if (symbol == nullptr && egl.get_proc_address != nullptr) {
        symbol = reinterpret_cast<void*>(egl.get_proc_address(name));
    }
    function = reinterpret_cast<Function>(symbol);
    return symbol != nullptr;
}

Egl load_egl() {
    Egl egl;
    void* library = dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) {
        egl.failure = fmt::format("libEGL.so.1 cannot be loaded ({}); {}", dlerror(), egl_cure);
        return egl;
    }
    const bool complete = look_up(library, egl, "eglGetProcAddress", egl.get_proc_address) &&
                          look_up(library, egl, "eglGetError", egl.get_error) &&
                          look_up(library, egl, "eglQueryString", egl.query_string) &&
                          look_up(library, egl, "eglInitialize", egl.initialize) &&
                          look_up(library, egl, "eglBindAPI", egl.bind_api) &&
                          look_up(library, egl, "eglChooseConfig", egl.choose_config) &&
                          look_up(library, egl, "eglCreateContext", egl.create_context) &&
                          look_up(library, egl, "eglDestroyContext", egl.destroy_context) &&
                          look_up(library, egl, "eglMakeCurrent", egl.make_current) &&
                          look_up(library, egl, "eglGetPlatformDisplayEXT", egl.get_platform_display);
    if (!complete) {
        egl.failure = "libEGL.so.1 lacks functions of EGL 1.5";
        return egl;
    }
    look_up(library, egl, "eglQueryDevicesEXT", egl.query_devices);
    look_up(library, egl, "eglQueryDeviceStringEXT", egl.query_device_string);
    return egl;
}

const Egl& egl_functions() {
    static const Egl egl = load_egl();
    return egl;
}

bool has_extension(const char* extensions, std::string_view name) {
    std::string_view rest = extensions == nullptr ? "" : extensions;
    while (!rest.empty()) {
        const std::size_t end = rest.find(' ');
        if (rest.substr(0, end) == name) {
            return true;
        }
        rest = end == std::string_view::npos ? "" : rest.substr(end + 1);
    }
    return false;
}

[[noreturn]] void fail(const std::string& step) {
    throw Error(ErrorKind::graphics, fmt::format("{} failed (EGL error 0x{:04x})", step,
                                                 static_cast<unsigned>(egl_functions().get_error())));
}

class EglContext final : public Context {
public:
    EglContext(EGLDisplay display, bool debug) : display_(display) {
        const Egl& egl = egl_functions();
        EGLint major = 0;
        EGLint minor = 0;
        if (egl.initialize(display_, &major, &minor) != EGL_TRUE) {
            fail("eglInitialize");
        }
        const char* extensions = egl.query_string(display_, EGL_EXTENSIONS);
        if (!has_extension(extensions, "EGL_KHR_surfaceless_context")) {
            throw Error(ErrorKind::graphics, "its contexts need a window (no EGL_KHR_surfaceless_context)");
        }
        if (egl.bind_api(EGL_OPENGL_API) != EGL_TRUE) {
            fail("eglBindAPI for OpenGL");
        }
        const EGLConfig config = choose_config(extensions);
        for (const int version_minor : {6, 5}) {
            context_ = create(config, version_minor, debug);
            if (context_ != EGL_NO_CONTEXT) {
                return;
            }
        }
        fail("creating an OpenGL 4.5 core context");
    }

    ~EglContext() override {
        shut_down();
        egl_functions().destroy_context(display_, context_);
    }

protected:
    void bind() override {
        const Egl& egl = egl_functions();
        egl.bind_api(EGL_OPENGL_API);
        if (egl.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) != EGL_TRUE) {
            fail("eglMakeCurrent");
        }
    }

    void unbind() noexcept override {
        const Egl& egl = egl_functions();
        egl.bind_api(EGL_OPENGL_API);
        egl.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }

    void* get_proc(const char* name) const override {
        return reinterpret_cast<void*>(egl_functions().get_proc_address(name));
    }

    Backend backend() const override { return Backend::egl; }

private:
    EGLConfig choose_config(const char* extensions) const {
        if (has_extension(extensions, "EGL_KHR_no_config_context") ||
            has_extension(extensions, "EGL_MESA_configless_context")) {
            return EGL_NO_CONFIG_KHR;
        }
        const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                 EGL_NONE};
        EGLConfig config = nullptr;
        EGLint count = 0;
        if (egl_functions().choose_config(display_, wanted, &config, 1, &count) != EGL_TRUE || count == 0) {
            fail("finding a configuration for OpenGL");
        }
        return config;
    }

    EGLContext create(EGLConfig config, int minor, bool debug) const {
        const EGLint attributes[] = {
            EGL_CONTEXT_MAJOR_VERSION,
            4,
            EGL_CONTEXT_MINOR_VERSION,
            minor,
            EGL_CONTEXT_OPENGL_PROFILE_MASK,
            EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
            EGL_CONTEXT_OPENGL_DEBUG,
            debug ? EGL_TRUE : EGL_FALSE,
            EGL_NONE,
        };
        return egl_functions().create_context(display_, config, EGL_NO_CONTEXT, attributes);
    }

    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLContext context_ = EGL_NO_CONTEXT;
};

std::unique_ptr<Context> open_display(EGLenum platform, void* native, bool debug) {
    const Egl& egl = egl_functions();
    const EGLDisplay display = egl.get_platform_display(platform, native, nullptr);
    if (display == EGL_NO_DISPLAY) {
        fail("eglGetPlatformDisplay");
    }
    return std::make_unique<EglContext>(display, debug);
}

Platform surfaceless_platform() {
    return {Backend::egl, "EGL surfaceless Mesa", "apt-get install libgl1-mesa-dri", [](bool debug) {
                return open_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, debug);
            }};
}

/// The devices of one sort; numbers are those of the enumeration, so that they name the same device always.
void add_devices(const std::vector<EGLDeviceEXT>& devices, bool software, std::vector<Platform>& platforms) {
    const Egl& egl = egl_functions();
    for (std::size_t index = 0; index < devices.size(); ++index) {
        const EGLDeviceEXT device = devices[index];
        const char* extensions = egl.query_device_string(device, EGL_EXTENSIONS);
        if (has_extension(extensions, "EGL_MESA_device_software") != software) {
            continue;
        }
        const char* cure =
            software ? "apt-get install libgl1-mesa-dri"
                     : "Install the OpenGL driver of this device, and give this user access to "
                       "/dev/dri (groups video and render); without it the software renderer is used.";
        platforms.push_back(
            {Backend::egl, fmt::format("EGL device {}{}", index, software ? " (software)" : ""), cure,
             [device](bool debug) { return open_display(EGL_PLATFORM_DEVICE_EXT, device, debug); }});
    }
}

std::vector<EGLDeviceEXT> enumerate_devices() {
    const Egl& egl = egl_functions();
    EGLint count = 0;
    if (egl.query_devices == nullptr || egl.query_device_string == nullptr ||
        egl.query_devices(0, nullptr, &count) != EGL_TRUE || count <= 0) {
        return {};
    }
    std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
    egl.query_devices(count, devices.data(), &count);
    devices.resize(static_cast<std::size_t>(count));
    return devices;
}

}  // namespace

std::vector<Platform> egl_platforms() {
    const Egl& egl = egl_functions();
    if (!egl.failure.empty()) {
        return {{Backend::egl, "EGL", egl_cure, [](bool) -> std::unique_ptr<Context> {
                     throw Error(ErrorKind::graphics, egl_functions().failure);
                 }}};
    }
    const std::vector<EGLDeviceEXT> devices = enumerate_devices();
    std::vector<Platform> platforms;
    add_devices(devices, false, platforms);
    platforms.push_back(surfaceless_platform());
    add_devices(devices, true, platforms);
    return platforms;
}

}  // namespace decalgl::gl

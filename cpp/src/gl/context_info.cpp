#include "gl/context_info.h"

#include "decalgl/core/error.h"

#include <set>

#include <fmt/format.h>

namespace decalgl::gl {
namespace {

/// What OpenGL 4.6 took in, by the extension that brings it to 4.5.
const char* const features_of_46[] = {
    "GL_ARB_gl_spirv",
    "GL_ARB_indirect_parameters",
    "GL_ARB_pipeline_statistics_query",
    "GL_ARB_polygon_offset_clamp",
    "GL_ARB_shader_atomic_counter_ops",
    "GL_ARB_shader_draw_parameters",
    "GL_ARB_shader_group_vote",
    "GL_ARB_spirv_extensions",
    "GL_ARB_texture_filter_anisotropic",
    "GL_ARB_transform_feedback_overflow_query",
    "GL_KHR_no_error",
};

std::string text_of(GLenum name) {
    const GLubyte* text = glGetString(name);
    return text == nullptr ? std::string() : std::string(reinterpret_cast<const char*>(text));
}

int integer_of(GLenum name) {
    GLint value = 0;
    glGetIntegerv(name, &value);
    return value;
}

bool is_software(const std::string& renderer) {
    for (const char* name : {"llvmpipe", "softpipe", "swrast", "SWR", "Software", "lavapipe"}) {
        if (renderer.find(name) != std::string::npos) {
            return true;
        }
    }
    return false;
}

std::vector<std::string> missing_features() {
    std::set<std::string> extensions;
    const int count = integer_of(GL_NUM_EXTENSIONS);
    for (int index = 0; index < count; ++index) {
        extensions.insert(
            reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, static_cast<GLuint>(index))));
    }
    std::vector<std::string> missing;
    for (const char* feature : features_of_46) {
        if (extensions.count(feature) == 0) {
            missing.emplace_back(feature);
        }
    }
    return missing;
}

}  // namespace

ContextInfo read_context_info(Backend backend, const std::string& platform) {
    ContextInfo info;
    info.backend = backend;
    info.platform = platform;
    info.vendor = text_of(GL_VENDOR);
    info.renderer = text_of(GL_RENDERER);
    info.version = text_of(GL_VERSION);
    info.glsl = text_of(GL_SHADING_LANGUAGE_VERSION);
    info.major = integer_of(GL_MAJOR_VERSION);
    info.minor = integer_of(GL_MINOR_VERSION);
    if (info.major < 4 || (info.major == 4 && info.minor < 5)) {
        throw Error(ErrorKind::graphics,
                    fmt::format("it gives OpenGL {} ({}), and 4.5 is needed", info.version, info.renderer));
    }
    info.software = is_software(info.renderer);
    info.max_texture_size = integer_of(GL_MAX_TEXTURE_SIZE);
    info.max_array_texture_layers = integer_of(GL_MAX_ARRAY_TEXTURE_LAYERS);
    info.max_texture_buffer_size = integer_of(GL_MAX_TEXTURE_BUFFER_SIZE);
    info.max_renderbuffer_size = integer_of(GL_MAX_RENDERBUFFER_SIZE);
    glGetIntegerv(GL_MAX_VIEWPORT_DIMS, info.max_viewport);
    info.max_samples = integer_of(GL_MAX_SAMPLES);
    info.max_uniform_block_bytes = integer_of(GL_MAX_UNIFORM_BLOCK_SIZE);
    GLint64 storage = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &storage);
    info.max_storage_block_bytes = storage;
    if (info.major == 4 && info.minor == 5) {
        info.missing_features = missing_features();
    }
    return info;
}

std::string error_name(GLenum code) {
    switch (code) {
        case GL_INVALID_ENUM:
            return "GL_INVALID_ENUM";
        case GL_INVALID_VALUE:
            return "GL_INVALID_VALUE";
        case GL_INVALID_OPERATION:
            return "GL_INVALID_OPERATION";
        case GL_INVALID_FRAMEBUFFER_OPERATION:
            return "GL_INVALID_FRAMEBUFFER_OPERATION";
        case GL_OUT_OF_MEMORY:
            return "GL_OUT_OF_MEMORY";
        case GL_CONTEXT_LOST:
            return "GL_CONTEXT_LOST";
        default:
            return fmt::format("error 0x{:04x}", code);
    }
}

}  // namespace decalgl::gl

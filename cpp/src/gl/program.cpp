#include "gl/program.h"

#include "decalgl/core/error.h"
#include "gl/context.h"
#include "gl/shader_source.h"

#include <algorithm>
#include <cctype>

#include <glm/gtc/type_ptr.hpp>

#include <fmt/format.h>

namespace decalgl::gl {
namespace {

struct Stage {
    GLenum type;
    std::string path;
    std::string text;
};

/// A shader object for the time until it is linked.
class Shader {
public:
    Shader(GLenum type, const StageText& stage, const std::string& variant) : name_(glCreateShader(type)) {
        const GLchar* text = stage.text.c_str();
        glShaderSource(name_, 1, &text, nullptr);
        glCompileShader(name_);
        GLint compiled = GL_FALSE;
        glGetShaderiv(name_, GL_COMPILE_STATUS, &compiled);
        if (compiled != GL_TRUE) {
            const std::string log = translate_log(this->log(), stage.files);
            glDeleteShader(name_);
            throw Error(ErrorKind::graphics,
                        fmt::format("The shader program {} does not compile:\n{}", variant, log));
        }
    }
    Shader(const Shader&) = delete;
    Shader& operator=(const Shader&) = delete;
    ~Shader() { glDeleteShader(name_); }

    GLuint name() const { return name_; }

private:
    std::string log() const {
        GLint size = 0;
        glGetShaderiv(name_, GL_INFO_LOG_LENGTH, &size);
        std::string log(static_cast<std::size_t>(std::max(size, 1)), '\0');
        glGetShaderInfoLog(name_, size, nullptr, log.data());
        log.resize(log.find('\0') == std::string::npos ? log.size() : log.find('\0'));
        return log;
    }

    GLuint name_;
};

std::string link_log(GLuint program) {
    GLint size = 0;
    glGetProgramiv(program, GL_INFO_LOG_LENGTH, &size);
    std::string log(static_cast<std::size_t>(std::max(size, 1)), '\0');
    glGetProgramInfoLog(program, size, nullptr, log.data());
    return log.c_str();
}

const ManifestProgram& find_program(const std::string& name) {
    std::string known;
    for (const ManifestProgram& program : shader_manifest()) {
        if (program.name == name) {
            return program;
        }
        known += fmt::format(" {}", program.name);
    }
    throw Error(ErrorKind::graphics,
                fmt::format("cpp/shaders/manifest.json has no program {}; it has:{}", name, known));
}

void check_flags(const ManifestProgram& program, const Flags& flags) {
    for (const std::string& flag : flags) {
        if (std::find(program.flags.begin(), program.flags.end(), flag) == program.flags.end()) {
            throw Error(ErrorKind::graphics,
                        fmt::format("The program {} has no flag {} in cpp/shaders/manifest.json.",
                                    program.name, flag));
        }
    }
}

bool is_word(char character) {
    return std::isalnum(static_cast<unsigned char>(character)) != 0 || character == '_';
}

/// Whether the first part of a uniform's name ("lights" of "lights[2].color") stands in the text as a word.
bool occurs(const std::string& text, const std::string& uniform) {
    const std::string word = uniform.substr(0, uniform.find_first_of("[."));
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
        const bool starts = at == 0 || !is_word(text[at - 1]);
        const bool ends = at + word.size() >= text.size() || !is_word(text[at + word.size()]);
        if (starts && ends) {
            return true;
        }
    }
    return false;
}

}  // namespace

class ProgramBuilder {
public:
    static Program build(const std::string& name, const Flags& flags, const std::vector<Stage>& stages) {
        Context::require_current();
        Program program;
        program.name_ = variant_name(name, flags);
        const std::vector<std::string> defines(flags.begin(), flags.end());
        std::vector<std::unique_ptr<Shader>> shaders;
        for (const Stage& stage : stages) {
            StageText text = assemble_stage(stage.path, stage.text, defines);
            shaders.push_back(std::make_unique<Shader>(stage.type, text, program.name_));
            program.text_ += text.text;
        }
        program.handle_ = ObjectHandle(ObjectType::program, glCreateProgram());
        link(program, shaders);
        check_errors(fmt::format("linking the program {}", program.name_).c_str());
        return program;
    }

private:
    static void link(const Program& program, const std::vector<std::unique_ptr<Shader>>& shaders) {
        const GLuint id = program.id();
        for (const auto& shader : shaders) {
            glAttachShader(id, shader->name());
        }
        glLinkProgram(id);
        for (const auto& shader : shaders) {
            glDetachShader(id, shader->name());
        }
        GLint linked = GL_FALSE;
        glGetProgramiv(id, GL_LINK_STATUS, &linked);
        if (linked != GL_TRUE) {
            throw Error(ErrorKind::graphics, fmt::format("The shader program {} does not link:\n{}",
                                                         program.name(), link_log(id)));
        }
        glObjectLabel(GL_PROGRAM, id, static_cast<GLsizei>(program.name().size()), program.name().c_str());
    }
};

Program Program::create(const std::string& name, const Flags& flags) {
    const ManifestProgram& program = find_program(name);
    check_flags(program, flags);
    std::vector<Stage> stages;
    const auto add = [&stages](GLenum type, std::string_view path) {
        if (!path.empty()) {
            stages.push_back({type, std::string(path), shader_source(path)});
        }
    };
    add(GL_VERTEX_SHADER, program.vertex);
    add(GL_GEOMETRY_SHADER, program.geometry);
    add(GL_FRAGMENT_SHADER, program.fragment);
    add(GL_COMPUTE_SHADER, program.compute);
    return ProgramBuilder::build(name, flags, stages);
}

Program Program::from_source(const std::string& name, const std::string& vertex, const std::string& fragment,
                             const Flags& flags) {
    return ProgramBuilder::build(
        name, flags,
        {{GL_VERTEX_SHADER, name + ".vert", vertex}, {GL_FRAGMENT_SHADER, name + ".frag", fragment}});
}

Program Program::compute_from_source(const std::string& name, const std::string& compute,
                                     const Flags& flags) {
    return ProgramBuilder::build(name, flags, {{GL_COMPUTE_SHADER, name + ".comp", compute}});
}

void Program::use() const {
    glUseProgram(id());
}

GLint Program::location(const std::string& name) {
    const auto known = locations_.find(name);
    if (known != locations_.end()) {
        return known->second;
    }
    const GLint location = glGetUniformLocation(id(), name.c_str());
    if (location < 0 && !occurs(text_, name)) {
        throw Error(ErrorKind::graphics, fmt::format("The program {} has no uniform {}.", name_, name));
    }
    locations_.emplace(name, location);
    return location;
}

// GL ignores location -1, so an optimised uniform needs no test.

void Program::set(const std::string& name, bool value) {
    glProgramUniform1i(id(), location(name), value ? 1 : 0);
}
void Program::set(const std::string& name, int value) {
    glProgramUniform1i(id(), location(name), value);
}
void Program::set(const std::string& name, unsigned value) {
    glProgramUniform1ui(id(), location(name), value);
}
void Program::set(const std::string& name, float value) {
    glProgramUniform1f(id(), location(name), value);
}
void Program::set(const std::string& name, const glm::vec2& value) {
    glProgramUniform2fv(id(), location(name), 1, glm::value_ptr(value));
}
void Program::set(const std::string& name, const glm::vec3& value) {
    glProgramUniform3fv(id(), location(name), 1, glm::value_ptr(value));
}
void Program::set(const std::string& name, const glm::vec4& value) {
    glProgramUniform4fv(id(), location(name), 1, glm::value_ptr(value));
}
void Program::set(const std::string& name, const glm::ivec2& value) {
    glProgramUniform2iv(id(), location(name), 1, glm::value_ptr(value));
}
void Program::set(const std::string& name, const glm::ivec3& value) {
    glProgramUniform3iv(id(), location(name), 1, glm::value_ptr(value));
}
void Program::set(const std::string& name, const glm::ivec4& value) {
    glProgramUniform4iv(id(), location(name), 1, glm::value_ptr(value));
}
void Program::set(const std::string& name, const glm::uvec2& value) {
    glProgramUniform2uiv(id(), location(name), 1, glm::value_ptr(value));
}
void Program::set(const std::string& name, const glm::uvec3& value) {
    glProgramUniform3uiv(id(), location(name), 1, glm::value_ptr(value));
}
void Program::set(const std::string& name, const glm::uvec4& value) {
    glProgramUniform4uiv(id(), location(name), 1, glm::value_ptr(value));
}
void Program::set(const std::string& name, const glm::mat3& value) {
    glProgramUniformMatrix3fv(id(), location(name), 1, GL_FALSE, glm::value_ptr(value));
}
void Program::set(const std::string& name, const glm::mat4& value) {
    glProgramUniformMatrix4fv(id(), location(name), 1, GL_FALSE, glm::value_ptr(value));
}

namespace {

GLsizei length_of(std::size_t count) {
    return static_cast<GLsizei>(count);
}

template <typename Vector>
const float* floats_of(Span<const Vector> values) {
    return reinterpret_cast<const float*>(values.data());
}

}  // namespace

void Program::set_array(const std::string& name, Span<const int> values) {
    glProgramUniform1iv(id(), location(name), length_of(values.size()), values.data());
}
void Program::set_array(const std::string& name, Span<const unsigned> values) {
    glProgramUniform1uiv(id(), location(name), length_of(values.size()), values.data());
}
void Program::set_array(const std::string& name, Span<const float> values) {
    glProgramUniform1fv(id(), location(name), length_of(values.size()), values.data());
}
void Program::set_array(const std::string& name, Span<const glm::vec2> values) {
    glProgramUniform2fv(id(), location(name), length_of(values.size()), floats_of(values));
}
void Program::set_array(const std::string& name, Span<const glm::vec3> values) {
    glProgramUniform3fv(id(), location(name), length_of(values.size()), floats_of(values));
}
void Program::set_array(const std::string& name, Span<const glm::vec4> values) {
    glProgramUniform4fv(id(), location(name), length_of(values.size()), floats_of(values));
}
void Program::set_array(const std::string& name, Span<const glm::mat4> values) {
    glProgramUniformMatrix4fv(id(), location(name), length_of(values.size()), GL_FALSE, floats_of(values));
}

Program& ProgramCache::get(const std::string& name, const Flags& flags) {
    std::unique_ptr<Program>& entry = programs_[{name, flags}];
    if (entry == nullptr) {
        entry = std::make_unique<Program>(Program::create(name, flags));
    }
    return *entry;
}

Program& ProgramLibrary::get(const std::string& name, const Flags& flags) {
    Program*& entry = programs_[{name, flags}];
    if (entry == nullptr) {
        entry = &Context::require_current().programs().get(name, flags);
    }
    return *entry;
}

std::vector<std::string> ProgramLibrary::variants() const {
    std::vector<std::string> names;
    for (const auto& [key, program] : programs_) {
        if (program != nullptr) {
            names.push_back(program->name());
        }
    }
    std::sort(names.begin(), names.end());
    return names;
}

std::string variant_name(const std::string& name, const Flags& flags) {
    return flags.empty() ? name : fmt::format("{}[{}]", name, fmt::join(flags, ","));
}

}  // namespace decalgl::gl

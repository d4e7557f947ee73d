#pragma once

// Programs by name, from the shaders built into the library (cpp/shaders and its manifest.json).
//
// A variant is a program's name and a set of flags; each flag becomes `#define FLAG 1`. Messages of the
// compiler name the file and line as they are in cpp/shaders, through any depth of includes.

#include "decalgl/core/span.h"
#include "gl/object.h"

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace decalgl::gl {

using Flags = std::set<std::string>;

class Program {
public:
    /// Compiles and links a variant in the current context. Throws Error(graphics) with the compiler's log
    /// in terms of shader files, or where the manifest has no such program or flag.
    static Program create(const std::string& name, const Flags& flags = {});

    /// Links stages given as text, for tests of small shader functions. Texts may include the library's
    /// shader files; `name` stands for the file name in messages.
    static Program from_source(const std::string& name, const std::string& vertex,
                               const std::string& fragment, const Flags& flags = {});
    static Program compute_from_source(const std::string& name, const std::string& compute,
                                       const Flags& flags = {});

    void use() const;

    /// Sets a uniform (no need for the program to be in use). A name the compiler optimised away is
    /// ignored; one that occurs in none of the stages' texts throws Error(graphics).
    void set(const std::string& name, bool value);
    void set(const std::string& name, int value);
    void set(const std::string& name, unsigned value);
    void set(const std::string& name, float value);
    void set(const std::string& name, const glm::vec2& value);
    void set(const std::string& name, const glm::vec3& value);
    void set(const std::string& name, const glm::vec4& value);
    void set(const std::string& name, const glm::ivec2& value);
    void set(const std::string& name, const glm::ivec3& value);
    void set(const std::string& name, const glm::ivec4& value);
    void set(const std::string& name, const glm::uvec2& value);
    void set(const std::string& name, const glm::uvec3& value);
    void set(const std::string& name, const glm::uvec4& value);
    void set(const std::string& name, const glm::mat3& value);
    void set(const std::string& name, const glm::mat4& value);

    /// Sets an array from its first element on; `name` without brackets.
    void set_array(const std::string& name, Span<const int> values);
    void set_array(const std::string& name, Span<const unsigned> values);
    void set_array(const std::string& name, Span<const float> values);
    void set_array(const std::string& name, Span<const glm::vec2> values);
    void set_array(const std::string& name, Span<const glm::vec3> values);
    void set_array(const std::string& name, Span<const glm::vec4> values);
    void set_array(const std::string& name, Span<const glm::mat4> values);

    const std::string& name() const { return name_; }
    GLuint id() const { return handle_.name(); }

private:
    friend class ProgramBuilder;

    GLint location(const std::string& name);

    ObjectHandle handle_;
    std::string name_;
    std::unordered_map<std::string, GLint> locations_;
    std::string text_;  ///< all stages, to tell an optimised uniform from a mistyped one
};

/// The variants that one context has compiled, each once.
class ProgramCache {
public:
    Program& get(const std::string& name, const Flags& flags);

private:
    std::map<std::pair<std::string, Flags>, std::unique_ptr<Program>> programs_;
};

/// The variants that someone has used so far, all of one context's.
class ProgramLibrary {
public:
    Program& get(const std::string& name, const Flags& flags = {});

    /// "terrain", "static_decals[HOLES,IDS]": what was used, in alphabetical order.
    std::vector<std::string> variants() const;

private:
    std::map<std::pair<std::string, Flags>, Program*> programs_;
};

/// "name[A,B]", or the plain name where there are no flags.
std::string variant_name(const std::string& name, const Flags& flags);

}  // namespace decalgl::gl

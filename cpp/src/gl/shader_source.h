#pragma once

// The shader files built into the library, and the joining of their includes.

#include "decalgl/core/span.h"

#include <string>
#include <string_view>
#include <vector>

namespace decalgl::gl {

/// A file below cpp/shaders by its path there ("terrain/terrain.vert.glsl"), or null.
const char* shader_source(std::string_view path);

/// A program of cpp/shaders/manifest.json; a stage it does not have is an empty path.
struct ManifestProgram {
    std::string_view name;
    std::string_view vertex;
    std::string_view geometry;
    std::string_view fragment;
    std::string_view compute;
    Span<const std::string_view> flags;
};

Span<const ManifestProgram> shader_manifest();

/// One stage, ready for the driver.
struct StageText {
    std::string text;
    std::vector<std::string> files;  ///< by source string number, as #line counts them
};

/// Puts the defines after the #version line and replaces every `#include "path"` by that file, once each.
/// Throws Error(graphics) where a file is missing. `root_path` names the root text in messages.
StageText assemble_stage(const std::string& root_path, const std::string& root_text,
                         const std::vector<std::string>& defines);

/// Rewrites the driver's "0:12(3)", "0(12)" and "ERROR: 0:12:" into "path:12".
std::string translate_log(const std::string& log, const std::vector<std::string>& files);

}  // namespace decalgl::gl

#include "technique/dynamic_lines/line_looks.h"

namespace decalgl {

void LineLooks::upload(const PreparedLines& prepared, const PreparedLines* lens,
                       const MemoryAccount& memory) {
    std::vector<LineStyle> styles(prepared.styles.begin(), prepared.styles.end());
    summary_ = prepared.summary;
    lens_texels_ = 0;
    if (lens != nullptr) {
        lens_texels_ = LINE_STYLE_TEXELS * static_cast<int>(styles.size());
        styles.insert(styles.end(), lens->styles.begin(), lens->styles.end());
        summary_.has_shown |= lens->summary.has_shown;
        summary_.has_hidden |= lens->summary.has_hidden;
        summary_.has_translucency |= lens->summary.has_translucency;
        summary_.is_joined |= lens->summary.is_joined;
        summary_.has_limits |= lens->summary.has_limits;
        summary_.has_one_look = false;
    }
    styles_ = gl::TextureBuffer();
    styles_ = gl::TextureBuffer::from(memory, "dynamic: styles", GL_RGBA32UI, styles);
}

void LineLooks::bind(gl::Program& program, GLuint unit) const {
    program.set("line_styles", static_cast<int>(unit));
    styles_.bind(unit);
    if (has_lens())
        program.set("lens_styles", lens_texels_);
}

gl::Flags LineLooks::flags() const {
    gl::Flags flags;
    if (summary_.is_joined)
        flags.insert("JOINED");
    if (summary_.has_limits)
        flags.insert("LIMITS");
    if (has_lens())
        flags.insert("LENS");
    return flags;
}

}  // namespace decalgl

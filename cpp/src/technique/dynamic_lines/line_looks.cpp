#include "technique/dynamic_lines/line_looks.h"

#include <algorithm>
#include <cmath>

namespace decalgl {
namespace {

constexpr GLuint patterns_unit = 9;

constexpr double radians = 3.14159265358979323846 / 180.0;

// How much farther than half a line's width its corners and caps reach.
float reach_of_joints(const LineStyle& style) {
    const double limit = static_cast<double>(style.kind >> MITER_SHIFT) / 256.0;
    const bool is_mitered = (style.kind & CORNER_MASK) == static_cast<uint32_t>(Corner::miter);
    const double tip = is_mitered ? 1.0 / std::sin(0.5 * radians * std::max(limit, 1.0)) : 1.0;
    return static_cast<float>(std::max(tip, std::sqrt(2.0)));  // a square cap's corner
}

LineReach reach_of(const std::vector<LineStyle>& styles, bool with_joints) {
    LineReach reach;
    for (const LineStyle& style : styles) {
        const bool in_metres = (style.kind & IN_METRES) != 0;
        const float joints = with_joints ? reach_of_joints(style) : 1.0F;
        const float px =
            std::min(std::max(in_metres ? 0.0F : style.half_width, style.least_px), style.most_px) +
            (in_metres ? 0.0F : style.margin);
        const float metres =
            std::min(std::max(in_metres ? style.half_width : 0.0F, style.least_metres), style.most_metres) +
            (in_metres ? style.margin : 0.0F);
        reach.px = std::max(reach.px, joints * px);
        reach.metres = std::max(reach.metres, joints * metres);
    }
    return reach;
}

}  // namespace

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
        summary_.is_styled |= lens->summary.is_styled;
        summary_.has_sides |= lens->summary.has_sides;
        summary_.has_limits |= lens->summary.has_limits;
        summary_.has_one_look = false;
    }
    reach_ = reach_of(styles, summary_.is_joined);
    styles_ = gl::TextureBuffer();
    styles_ = gl::TextureBuffer::from(memory, "dynamic: styles", GL_RGBA32UI, styles);
    patterns_ = gl::TextureBuffer();
    if (summary_.is_styled) {
        const std::vector<PatternTexel> patterns(prepared.patterns.begin(), prepared.patterns.end());
        patterns_ = gl::TextureBuffer::from(memory, "dynamic: styles", GL_RGBA32F, patterns);
    }
    first_octave_ = first_octave(prepared.lattice);
}

void LineLooks::bind(gl::Program& program, GLuint unit) const {
    program.set("line_styles", static_cast<int>(unit));
    styles_.bind(unit);
    if (has_lens())
        program.set("lens_styles", lens_texels_);
    if (summary_.is_styled) {
        program.set("line_patterns", static_cast<int>(patterns_unit));
        patterns_.bind(patterns_unit);
        program.set("first_octave", first_octave_);
    }
}

gl::Flags LineLooks::flags() const {
    gl::Flags flags;
    if (summary_.is_joined)
        flags.insert("JOINED");
    if (summary_.has_limits)
        flags.insert("LIMITS");
    if (summary_.is_styled)
        flags.insert("STYLED");
    if (has_lens())
        flags.insert("LENS");
    return flags;
}

}  // namespace decalgl

#include "technique/distance_field/field_targets.h"

#include <limits>
#include <tuple>
#include <vector>

#include "gl/gl.h"

namespace decalgl::network {

bool FieldFormat::operator==(const FieldFormat& other) const {
    const auto all = [](const FieldFormat& f) {
        return std::tie(f.width, f.height, f.layers, f.bits, f.angles, f.lengths, f.depths, f.nearest);
    };
    return all(*this) == all(other);
}

FieldTargets::FieldTargets(const FieldFormat& format, const MemoryAccount& memory) : format_(format) {
    const bool is_wide = format.bits == 32;
    const GLenum one = is_wide ? GL_R32F : GL_R8, two = is_wide ? GL_RG32F : GL_RG8;
    const auto array = [&](const char* name, GLenum texel) {
        return gl::Texture2D::create_array(memory, name, texel, format.width, format.height, format.layers);
    };
    std::vector<gl::Attachment> attachments;
    cross = array("distance_field: cross distances", format.angles ? two : one);
    attachments.push_back({GL_COLOR_ATTACHMENT0, &cross});
    if (format.lengths) {
        length = array("distance_field: lengths", one);
        attachments.push_back({GL_COLOR_ATTACHMENT1, &length});
    }
    if (format.depths) {
        depth = array("distance_field: depths", one);
        attachments.push_back({GL_COLOR_ATTACHMENT2, &depth});
    }
    if (format.nearest) {
        nearest = array("distance_field: nearest", GL_DEPTH_COMPONENT32F);
        attachments.push_back({GL_DEPTH_ATTACHMENT, &nearest});
    }
    framebuffer_ = gl::Framebuffer::create("distance fields", attachments);
}

void FieldTargets::begin() const {
    const float far = format_.bits == 32 ? std::numeric_limits<float>::max() : 1.0F;
    framebuffer_.bind();
    framebuffer_.clear_color(0, 1.0F, 1.0F, 1.0F, 1.0F);
    if (format_.lengths)
        framebuffer_.clear_color(1, far, far, far, far);
    if (format_.depths)
        framebuffer_.clear_color(2, 1.0F, 1.0F, 1.0F, 1.0F);
    if (format_.nearest)
        framebuffer_.clear_depth(1.0F);
}

}  // namespace decalgl::network

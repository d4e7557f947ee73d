#include "technique/shadow_volumes/shadow_volumes.h"

#include <utility>

#include "decalgl/core/error.h"
#include "gl/gl.h"
#include "gl/pass_timer.h"
#include "gl/texture.h"

namespace decalgl {

using volume::Batch;
using volume::PreparedVolumes;
using volume::ScreenBox;
using volume::Volume;
using volume::VolumeView;

namespace {

constexpr GLuint counted_bits = 0x7F;  // of translucent groups
constexpr GLint covered_bit = 0x80;    // by earlier batches

[[noreturn]] void refuse_files() {
    throw Error(ErrorKind::unsupported,
                "technique 'volume' is not kept on disk; draw the layer with technique 'static' to save the scene");
}

[[noreturn]] void refuse_changes() {
    throw Error(ErrorKind::unsupported,
                "technique 'volume' stays as it was prepared; draw the layer with technique 'static' to restyle or "
                "edit it");
}

}  // namespace

void PreparedVolumes::save(ArchiveWriter&, const std::string&) const {
    refuse_files();
}

LayerLook PreparedVolumes::look_of(uint32_t, size_t) const {
    refuse_changes();
}

std::shared_ptr<const Prepared> PreparedVolumes::restyled(Span<const LayerLook>, const MemoryAccount&) const {
    refuse_changes();
}

std::shared_ptr<const Prepared> PreparedVolumes::edited(const LayerEdit&, const MemoryAccount&) const {
    refuse_changes();
}

std::unique_ptr<const Prepared> ShadowVolumes::open(const ArchiveReader&, const std::string&,
                                                    const MemoryAccount&) const {
    refuse_files();
}

std::unique_ptr<const Prepared> ShadowVolumes::preprocess(const TechniqueInput& input,
                                                          Progress& progress) const {
    return volume::build_volumes(input, progress);
}

void ShadowVolumes::upload(std::shared_ptr<const Prepared> prepared, std::shared_ptr<const Prepared>,
                           const TerrainView&, const MemoryAccount& memory) {
    prepared_ = std::static_pointer_cast<const PreparedVolumes>(std::move(prepared));
    vertices_ = {};
    corners_ = {};
    const auto span_of = [](const auto& array) { return Span(array.data(), array.size()); };
    vertices_ = gl::TextureBuffer::from(memory, "volume: vertices", GL_RGBA32I, span_of(prepared_->vertices));
    corners_ = gl::Buffer::from(memory, "volume: corners", span_of(prepared_->corners));
    mesh_ = gl::VertexArray::create();
    mesh_.set_elements(corners_);
    no_vertices_ = gl::VertexArray::create();
}

UpdateReport ShadowVolumes::update(const View& view) {
    if (view.antialias == Antialias::coverage)
        throw Error(ErrorKind::unsupported,
                    "technique 'volume' masks whole pixels and cannot draw antialias='coverage'; use 'ssaa', 'msaa', "
                    "'fxaa' or 'none', or draw the layers with technique 'static'");
    UpdateReport report;
    report.pieces = prepared_->corners.size() / 3;
    report.bytes = vertices_.buffer().bytes() + corners_.bytes();
    report.counts = {{"volumes", static_cast<double>(prepared_->volumes.size())},
                     {"volume_groups", static_cast<double>(prepared_->groups.size())},
                     {"volume_batches", static_cast<double>(prepared_->batches.size())}};
    return report;
}

// The depth that volumes are counted against, and what all of them are drawn with.
void ShadowVolumes::begin(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    glClearBufferfi(GL_DEPTH_STENCIL, 0, 0.0F, 0);
    gl::Program& depth = programs.get("volume_depth");
    depth.use();
    depth.set("surface_texture", 0);
    gbuffer.surface->bind(0);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    draw_full_screen();
    glDepthMask(GL_FALSE);
    // A face fails where it lies behind the surface: depth is reversed.
    glDepthFunc(GL_GEQUAL);
    glEnable(GL_DEPTH_CLAMP);
    glEnable(GL_STENCIL_TEST);
    glEnable(GL_SCISSOR_TEST);

    seen_ = VolumeView(view, prepared_->lattice, gbuffer.surface->width(), gbuffer.surface->height());
    gl::Program& program = programs.get("volume");
    program.use();
    program.set("volume_vertices", 1);
    vertices_.bind(1);
    program.set("base_place", seen_.base_place());
    program.set("base_past", seen_.base_past());
    program.set("quantum", static_cast<float>(prepared_->lattice.quantum));
    program.set("terrain_error", static_cast<float>(view.terrain_error));
}

void ShadowVolumes::end() {
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_STENCIL_TEST);
    glDisable(GL_DEPTH_CLAMP);
    glDisable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glDepthMask(GL_TRUE);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

template <typename VolumeAt>
bool ShadowVolumes::count(uint32_t first, uint32_t end, VolumeAt volume_at, gl::Program& program) {
    counts_.clear();
    starts_.clear();
    ScreenBox box;
    uint32_t next = 0;
    for (uint32_t i = first; i < end; ++i) {
        const Volume& volume = volume_at(i);
        const ScreenBox own = seen_.box_of(volume);
        if (own.empty())
            continue;
        box.add(own);
        if (counts_.empty() || volume.first_corner != next) {
            counts_.push_back(0);
            starts_.push_back(reinterpret_cast<const void*>(volume.first_corner * sizeof(uint32_t)));
        }
        counts_.back() += static_cast<GLsizei>(volume.corner_count);
        next = volume.first_corner + volume.corner_count;
    }
    if (counts_.empty())
        return false;
    in_hand_.add(box);
    glScissor(box.left, box.bottom, box.right - box.left, box.top - box.bottom);
    program.use();
    glStencilFunc(GL_ALWAYS, 0, 0xFF);
    glStencilOpSeparate(GL_FRONT, GL_KEEP, GL_DECR_WRAP, GL_KEEP);
    glStencilOpSeparate(GL_BACK, GL_KEEP, GL_INCR_WRAP, GL_KEEP);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glEnable(GL_DEPTH_TEST);
    const glm::ivec4& picture = seen_.picture();
    glViewport(-picture.x, -picture.y, picture.z, picture.w);
    mesh_.bind();
    glMultiDrawElements(GL_TRIANGLES, counts_.data(), GL_UNSIGNED_INT, starts_.data(),
                        static_cast<GLsizei>(counts_.size()));
    return true;
}

// Counts of a batch become one bit, so that the next batch can be counted beside it.
void ShadowVolumes::fold() {
    glDisable(GL_DEPTH_TEST);
    glStencilFunc(GL_NOTEQUAL, covered_bit, counted_bits);
    glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
    draw_full_screen();
}

void ShadowVolumes::draw(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    const GLfloat nothing[] = {0.0F, 0.0F, 0.0F, 0.0F};
    if (!view.has_below)
        glClearBufferfv(GL_COLOR, 0, nothing);
    begin(view, gbuffer, programs);
    gl::Program& counting = programs.get("volume");
    gl::Program& mask = programs.get("volume_mask");
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    const auto volume_at = [&](uint32_t i) -> const Volume& { return prepared_->volumes[i]; };
    in_hand_ = {};
    for (size_t i = 0; i < prepared_->batches.size(); ++i) {
        const Batch& batch = prepared_->batches[i];
        const bool goes_on = i + 1 < prepared_->batches.size() && prepared_->batches[i + 1].group == batch.group;
        const std::array<uint8_t, 4>& color = prepared_->groups[batch.group].color;
        const bool is_opaque = color[3] == 255;
        count(batch.first_volume, batch.first_volume + batch.volume_count, volume_at, counting);
        if (in_hand_.empty())
            continue;
        glScissor(in_hand_.left, in_hand_.bottom, in_hand_.right - in_hand_.left, in_hand_.top - in_hand_.bottom);
        mask.use();
        if (goes_on && !is_opaque) {
            fold();
            continue;
        }
        const float alpha = static_cast<float>(color[3]) / 255.0F;
        mask.set("color", glm::vec4(static_cast<float>(color[0]) / 255.0F * alpha,
                                    static_cast<float>(color[1]) / 255.0F * alpha,
                                    static_cast<float>(color[2]) / 255.0F * alpha, alpha));
        if (!is_opaque)
            glEnable(GL_BLEND);
        lay_mask();
        glDisable(GL_BLEND);
        in_hand_ = {};
    }
    end();
}

// Decal by decal: a mask of many tells nothing of which one it shows.
void ShadowVolumes::draw_ids(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    const GLuint nothing[] = {0, 0, 0, 0};
    glClearBufferuiv(GL_COLOR, 0, nothing);
    begin(view, gbuffer, programs);
    gl::Program& counting = programs.get("volume");
    gl::Program& mask = programs.get("volume_mask", {"IDS"});
    const auto volume_at = [&](uint32_t i) -> const Volume& {
        return prepared_->volumes[prepared_->volumes_of[i]];
    };
    for (uint32_t decal = 0; decal < prepared_->decals.size(); ++decal) {
        for (uint32_t i = prepared_->first_volume_of[decal]; i < prepared_->first_volume_of[decal + 1]; ++i) {
            in_hand_ = {};
            if (!count(i, i + 1, volume_at, counting))
                continue;
            mask.use();
            mask.set("id", decal);
            lay_mask();
        }
    }
    end();
}

// Draws where anything was counted, and forgets the counts.
void ShadowVolumes::lay_mask() {
    glDisable(GL_DEPTH_TEST);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glStencilFunc(GL_NOTEQUAL, 0, 0xFF);
    glStencilOp(GL_KEEP, GL_KEEP, GL_ZERO);
    draw_full_screen();
}

void ShadowVolumes::draw_full_screen() {
    no_vertices_.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace decalgl

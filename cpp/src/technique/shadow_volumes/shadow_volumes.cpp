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

}  // namespace

std::unique_ptr<const Prepared> ShadowVolumes::open(const ArchiveReader& archive, const std::string& prefix,
                                                    const MemoryAccount&) const {
    return volume::open_volumes(archive, prefix);
}

std::unique_ptr<const Prepared> ShadowVolumes::preprocess(const TechniqueInput& input,
                                                          Progress& progress) const {
    return volume::build_volumes(input, progress);
}

void ShadowVolumes::upload(std::shared_ptr<const Prepared> prepared, std::shared_ptr<const Prepared> lens,
                           const TerrainView&, const MemoryAccount& memory) {
    outside_ = std::static_pointer_cast<const PreparedVolumes>(std::move(prepared));
    inside_ = std::static_pointer_cast<const PreparedVolumes>(std::move(lens));
    if (mesh_ && uploaded_ == outside_->vertices.data())
        return;
    mesh_ = {};
    vertices_ = {};
    corners_ = {};
    vertices_ = gl::TextureBuffer::from(memory, "volume: vertices", GL_RGB32I, outside_->vertices.span());
    corners_ = gl::Buffer::from(memory, "volume: corners", outside_->corners.span());
    no_vertices_ = gl::VertexArray::create();
    mesh_ = gl::VertexArray::create();
    mesh_.set_elements(corners_);
    uploaded_ = outside_->vertices.data();
}

UpdateReport ShadowVolumes::update(const View& view) {
    if (view.antialias == Antialias::coverage)
        throw Error(
            ErrorKind::unsupported,
            "technique 'volume' masks whole pixels and cannot draw antialias='coverage'; use 'ssaa', 'msaa', "
            "'fxaa' or 'none', or draw the layers with technique 'static'");
    UpdateReport report;
    report.pieces = outside_->corners.size() / 3;
    report.bytes = vertices_.buffer().bytes() + corners_.bytes();
    report.counts = {{"volumes", static_cast<double>(outside_->drawn.size())},
                     {"volume_groups", static_cast<double>(outside_->groups.size())},
                     {"volume_batches", static_cast<double>(outside_->batches.size())}};
    return report;
}

// The depth that volumes are counted against, and what all of them are drawn with. On the other side of the lens nothing
// is counted, as in the sky.
void ShadowVolumes::begin(LensSide side, const View& view, const GBufferView& gbuffer,
                          gl::ProgramLibrary& programs) {
    glClearBufferfi(GL_DEPTH_STENCIL, 0, 0.0F, 0);
    gl::Program& depth = programs.get("volume_depth", inside_ ? gl::Flags{"LENS"} : gl::Flags{});
    depth.use();
    if (inside_) {
        depth.set("lens_side", static_cast<int>(side));
        depth.set("lens_texture", 2);
        gbuffer.lens->bind(2);
    }
    depth.set("surface_texture", 0);
    gbuffer.surface->bind(0);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    draw_full_screen();
    glDepthMask(GL_FALSE);
    // What counts lies behind the surface: depth is reversed. So what is counted passes, and queries can tell how much.
    glDepthFunc(GL_LESS);
    glEnable(GL_DEPTH_CLAMP);
    glEnable(GL_STENCIL_TEST);
    glEnable(GL_SCISSOR_TEST);

    seen_ = VolumeView(view, outside_->lattice, gbuffer.surface->width(), gbuffer.surface->height());
    gl::Program& program = programs.get("volume");
    program.use();
    program.set("volume_vertices", 1);
    vertices_.bind(1);
    program.set("base_place", seen_.base_place());
    program.set("base_past", seen_.base_past());
    program.set("quantum", static_cast<float>(outside_->lattice.quantum));
    program.set("height_steps", glm::vec2(outside_->height_steps.lowest, outside_->height_steps.step));
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
    first_vertices_.clear();
    ScreenBox box;
    uint32_t next = 0;
    for (uint32_t i = first; i < end; ++i) {
        const Volume& volume = volume_at(i);
        const ScreenBox own = seen_.box_of(volume);
        if (own.empty())
            continue;
        box.add(own);
        const auto first_vertex = static_cast<GLint>(2 * volume.first_vertex);
        if (counts_.empty() || volume.first_corner != next || first_vertices_.back() != first_vertex) {
            counts_.push_back(0);
            starts_.push_back(reinterpret_cast<const void*>(volume.first_corner * sizeof(uint16_t)));
            first_vertices_.push_back(first_vertex);
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
    glStencilOpSeparate(GL_FRONT, GL_KEEP, GL_KEEP, GL_DECR_WRAP);
    glStencilOpSeparate(GL_BACK, GL_KEEP, GL_KEEP, GL_INCR_WRAP);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glEnable(GL_DEPTH_TEST);
    const glm::ivec4& picture = seen_.picture();
    glViewport(-picture.x, -picture.y, picture.z, picture.w);
    mesh_.bind();
    glMultiDrawElementsBaseVertex(GL_TRIANGLES, counts_.data(), GL_UNSIGNED_SHORT, starts_.data(),
                                  static_cast<GLsizei>(counts_.size()), first_vertices_.data());
    return true;
}

// Counts of a batch become one bit, so that the next batch can be counted beside it.
void ShadowVolumes::fold() {
    glDisable(GL_DEPTH_TEST);
    glStencilFunc(GL_NOTEQUAL, covered_bit, counted_bits);
    glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
    draw_full_screen();
}

template <typename SideFn>
void ShadowVolumes::draw_sides(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs,
                               SideFn draw_side) {
    for (const LensSide side : {LensSide::outside, LensSide::inside}) {
        const auto& prepared = side == LensSide::outside ? outside_ : inside_;
        if (!prepared)
            continue;
        begin(side, view, gbuffer, programs);
        draw_side(*prepared);
        end();
    }
}

void ShadowVolumes::draw(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    const GLfloat nothing[] = {0.0F, 0.0F, 0.0F, 0.0F};
    if (!view.has_below)
        glClearBufferfv(GL_COLOR, 0, nothing);
    draw_sides(view, gbuffer, programs,
               [&](const PreparedVolumes& prepared) { draw_groups(prepared, programs); });
}

void ShadowVolumes::draw_ids(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    const GLuint nothing[] = {0, 0, 0, 0};
    glClearBufferuiv(GL_COLOR, 0, nothing);
    draw_sides(view, gbuffer, programs,
               [&](const PreparedVolumes& prepared) { draw_decals(prepared, programs); });
}

void ShadowVolumes::draw_groups(const PreparedVolumes& prepared, gl::ProgramLibrary& programs) {
    gl::Program& counting = programs.get("volume");
    gl::Program& mask = programs.get("volume_mask");
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    const auto volume_at = [&](uint32_t i) -> const Volume& { return prepared.volumes[prepared.drawn[i]]; };
    in_hand_ = {};
    for (size_t i = 0; i < prepared.batches.size(); ++i) {
        const Batch& batch = prepared.batches[i];
        const bool goes_on = i + 1 < prepared.batches.size() && prepared.batches[i + 1].group == batch.group;
        const volume::Color& color = prepared.groups[batch.group];
        const bool is_opaque = color[3] == 255;
        count(batch.first_drawn, batch.first_drawn + batch.volume_count, volume_at, counting);
        if (in_hand_.empty())
            continue;
        glScissor(in_hand_.left, in_hand_.bottom, in_hand_.right - in_hand_.left,
                  in_hand_.top - in_hand_.bottom);
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
}

// One by one: a mask of many tells nothing of which one it shows.
void ShadowVolumes::draw_decals(const PreparedVolumes& prepared, gl::ProgramLibrary& programs) {
    gl::Program& counting = programs.get("volume");
    gl::Program& mask = programs.get("volume_mask", {"IDS"});
    const auto volume_at = [&](uint32_t i) -> const Volume& { return prepared.volumes[i]; };
    for (const uint32_t decal : prepared.upwards) {
        if (!prepared.shows(decal))
            continue;
        for (uint32_t i = prepared.first_volume_of[decal]; i < prepared.first_volume_of[decal + 1]; ++i) {
            in_hand_ = {};
            if (!count(i, i + 1, volume_at, counting))
                continue;
            mask.use();
            mask.set("id", decal);
            lay_mask();
        }
    }
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

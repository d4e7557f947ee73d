#include "technique/clipmap/clipmap.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "decalgl/core/error.h"
#include "gl/gl.h"
#include "gl/pass_timer.h"
#include "gl/readback.h"
#include "shared/view_block.h"

namespace decalgl {

using clipmap::finest_level;
using clipmap::PreparedClipmap;
using clipmap::Tile;
using clipmap::tile_bits;

namespace {

constexpr int feedback_step = 8;  // pixels

[[noreturn]] void refuse(const char* what) {
    throw Error(ErrorKind::unsupported, std::string("technique 'clipmap' ") + what +
                                            "; draw the layer with technique 'static' instead");
}

int window_for(const clipmap::ClipmapOptions& options, const View& view) {
    const int wanted = options.window > 0 ? options.window : std::max(view.width, view.height);
    int tiles = 2;
    while (tiles * clipmap::tile_texels < wanted && tiles < 16)
        tiles *= 2;
    return tiles;
}

}  // namespace

std::vector<FeatureReference> PreparedClipmap::query(const SeenPoint&) const {
    refuse("keeps colours alone, so nothing can be picked");
}

void PreparedClipmap::save(ArchiveWriter&, const std::string&) const {
    refuse("is not kept on disk");
}

LayerLook PreparedClipmap::look_of(uint32_t, size_t) const {
    refuse("stays as it was prepared");
}

std::shared_ptr<const Prepared> PreparedClipmap::restyled(Span<const LayerLook>, const MemoryAccount&) const {
    refuse("stays as it was prepared");
}

std::shared_ptr<const Prepared> PreparedClipmap::edited(const LayerEdit&, const MemoryAccount&) const {
    refuse("stays as it was prepared");
}

std::unique_ptr<const Prepared> Clipmap::open(const ArchiveReader&, const std::string&,
                                              const MemoryAccount&) const {
    refuse("is not kept on disk");
}

std::unique_ptr<const Prepared> Clipmap::preprocess(const TechniqueInput& input, Progress& progress) const {
    return clipmap::build_clipmap(input, progress);
}

void Clipmap::upload(std::shared_ptr<const Prepared> prepared, std::shared_ptr<const Prepared>,
                     const TerrainView&, const MemoryAccount& memory) {
    memory_ = memory;
    painter_ = {};
    store_ = {};
    prepared_ = std::static_pointer_cast<const PreparedClipmap>(std::move(prepared));
    painter_ = clipmap::TilePainter(*prepared_, memory_);
    no_vertices_ = gl::VertexArray::create();
}

UpdateReport Clipmap::update(const View& view) {
    in_areas_ = view.antialias == Antialias::coverage;
    const int window = window_for(prepared_->options, view);
    if (store_.window() != window) {
        store_ = {};
        store_ = clipmap::TileStore(window, memory_);
    }
    tiles_drawn_ = 0;
    UpdateReport report;
    report.pieces = prepared_->counts().pieces;
    report.bytes = painter_.bytes() + store_.bytes();
    report.counts = {{"clipmap_window", static_cast<double>(window * clipmap::tile_texels)}};
    return report;
}

void Clipmap::set_place(const View& view, const GBufferView& gbuffer, gl::Program& program) const {
    program.use();
    program.set("position_texture", 0);
    gbuffer.position->bind(0);
    program.set("surface_texture", 1);
    gbuffer.surface->bind(1);
    const double texel = prepared_->texture.texel(finest_level);
    program.set("first_block",
                glm::ivec2(prepared_->texture.first_block_x, prepared_->texture.first_block_y));
    program.set("texels_per_block", static_cast<int>(std::lrint(view.positions.block_size / texel)));
    program.set("texels_per_metre", static_cast<float>(1.0 / texel));
    program.set("anisotropy", static_cast<float>(prepared_->options.anisotropy));
}

std::vector<Tile> Clipmap::needed_tiles(const View& view, const GBufferView& gbuffer,
                                        gl::ProgramLibrary& programs) {
    const int width = (gbuffer.position->width() + feedback_step - 1) / feedback_step;
    const int height = (gbuffer.position->height() + feedback_step - 1) / feedback_step;
    if (!feedback_ || feedback_.width() != width || feedback_.height() != height) {
        feedback_ = gl::Texture2D::create(memory_, "clipmap: feedback", GL_RGBA32I, width, height);
        feedback_framebuffer_ = gl::Framebuffer::create("feedback", {{GL_COLOR_ATTACHMENT0, &feedback_}});
    }
    gl::Program& program = programs.get("clipmap_feedback");
    feedback_framebuffer_.bind();
    set_place(view, gbuffer, program);
    program.set("step_size", feedback_step);
    no_vertices_.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    const std::vector<int32_t> needed = gl::read_pixels<int32_t>(
        feedback_framebuffer_, GL_COLOR_ATTACHMENT0, 0, 0, width, height, gl::transfer_format(GL_RGBA32I), 4);

    std::vector<Tile> tiles{{0, 0, 0}};
    for (size_t i = 0; i < needed.size(); i += 4) {
        const int detail = needed[i + 2];
        if (detail < 0)
            continue;
        for (int level = finest_level - detail; level >= std::max(0, finest_level - detail - 1); --level) {
            const int shift = finest_level - level;
            // Pixels up to the next one that is asked, and what filtering reads beside them.
            const int64_t reach = int64_t{feedback_step / 2 * needed[i + 3] + 2} << shift;
            const auto tile_at = [&](int32_t texel, int64_t offset) {
                const int64_t limit = (int64_t{1} << (finest_level + tile_bits)) - 1;
                return static_cast<int>(std::clamp<int64_t>(texel + offset, 0, limit) >> (shift + tile_bits));
            };
            for (int y = tile_at(needed[i + 1], -reach); y <= tile_at(needed[i + 1], reach); ++y)
                for (int x = tile_at(needed[i], -reach); x <= tile_at(needed[i], reach); ++x)
                    tiles.push_back({level, x, y});
        }
    }
    return tiles;
}

void Clipmap::draw_tiles(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    std::vector<Tile> needed;
    {
        const gl::PassTimer timer(view.timings, "clipmap feedback");
        needed = needed_tiles(view, gbuffer, programs);
    }
    const gl::PassTimer timer(view.timings, "clipmap tiles");
    std::vector<Tile> missing = store_.choose(std::move(needed));
    const auto budget = static_cast<size_t>(prepared_->options.tiles_a_frame);
    if (budget > 0 && missing.size() > budget)
        missing.resize(budget);
    for (const Tile& tile : missing) {
        painter_.draw(*prepared_, tile, store_, programs);
        store_.set_drawn(tile);
    }
    tiles_drawn_ += missing.size();
    store_.upload_table();
}

void Clipmap::draw(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    GLint target = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &target);
    // Samples of silhouettes see what the picture's pixels see: their tiles are there.
    const bool gathered = in_areas_ && view.antialias == Antialias::none;
    if (!gathered)
        draw_tiles(view, gbuffer, programs);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(target));
    glViewport(0, 0, gbuffer.position->width(), gbuffer.position->height());
    gl::Program& program = programs.get("clipmap", gathered ? gl::Flags{"GATHERED_FOOTPRINT"} : gl::Flags{});
    set_place(view, gbuffer, program);
    program.set("tiles", 2);
    store_.texels().bind(2);
    program.set("table", 3);
    store_.table().bind(3);
    program.set("window", store_.window());
    if (view.has_below) {
        glEnable(GL_BLEND);
        glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    }
    no_vertices_.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDisable(GL_BLEND);
}

void Clipmap::draw_ids(const View&, const GBufferView&, gl::ProgramLibrary&) {
    refuse("keeps colours alone and knows no ids");
}

}  // namespace decalgl

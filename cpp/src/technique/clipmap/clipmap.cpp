#include "technique/clipmap/clipmap.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "decalgl/core/error.h"
#include "gl/gl.h"
#include "gl/pass_timer.h"
#include "gl/readback.h"
#include "technique/view_base.h"

namespace decalgl {

using clipmap::finest_level;
using clipmap::PreparedClipmap;
using clipmap::Tile;
using clipmap::tile_bits;

namespace {

constexpr int feedback_step = 8;  // pixels

int window_for(const clipmap::ClipmapOptions& options, const View& view) {
    const int wanted = options.window > 0 ? options.window : std::max(view.width, view.height);
    int tiles = 2;
    while (tiles * clipmap::tile_texels < wanted && tiles < 16)
        tiles *= 2;
    return tiles;
}

// From the eye to the ground under it, or to what is nearest to that on the terrain's edge.
double ground_distance(const Heightfield& terrain, const std::array<double, 3>& eye) {
    const Bounds bounds = terrain.bounds();
    const double x = std::clamp(eye[0], bounds.min_x, bounds.max_x),
                 y = std::clamp(eye[1], bounds.min_y, bounds.max_y);
    const auto index = [](double place, int32_t count) {
        return std::clamp(static_cast<int32_t>(std::lrint(place)), 0, count - 1);
    };
    const float height = terrain.height(index((terrain.y0() - y) / terrain.dy(), terrain.rows()),
                                        index((x - terrain.x0()) / terrain.dx(), terrain.columns()));
    const double ground = static_cast<double>(std::isnan(height) ? terrain.lowest() : height);
    return std::hypot(eye[0] - x, eye[1] - y, eye[2] - ground);
}

}  // namespace

std::unique_ptr<const Prepared> Clipmap::open(const ArchiveReader&, const std::string&,
                                              const MemoryAccount&) const {
    throw Error(ErrorKind::unsupported, "technique 'clipmap' is not kept on disk; prepare the scene anew");
}

std::unique_ptr<const Prepared> Clipmap::preprocess(const TechniqueInput& input, Progress& progress) const {
    return clipmap::build_clipmap(input, progress);
}

void Clipmap::upload(std::shared_ptr<const Prepared> prepared, std::shared_ptr<const Prepared> lens,
                     const TerrainView& terrain, const MemoryAccount& memory) {
    memory_ = memory;
    terrain_ = *terrain.samples;
    const auto set_side = [&](std::shared_ptr<const Prepared> own, Side& side) {
        if (!own) {
            side = {};
            return;
        }
        if (side.prepared == own)
            return;
        side.prepared = std::static_pointer_cast<const PreparedClipmap>(std::move(own));
        side.painter.use(side.prepared, side.wider, memory_);
        side.store.forget();
    };
    set_side(std::move(prepared), outside_);
    set_side(std::move(lens), inside_);
    if (!no_vertices_)
        no_vertices_ = gl::VertexArray::create();
}

UpdateReport Clipmap::update(const View& view) {
    in_areas_ = view.antialias == Antialias::coverage;
    update_side(view, outside_);
    if (inside_.prepared)
        update_side(view, inside_);
    UpdateReport report;
    report.pieces = outside_.prepared->counts().pieces;
    report.bytes = outside_.bytes() + inside_.bytes();
    report.counts = {{"clipmap_window", static_cast<double>(outside_.store.window() * clipmap::tile_texels)},
                     {"clipmap_wider", outside_.wider}};
    return report;
}

void Clipmap::update_side(const View& view, Side& side) {
    const clipmap::ClipmapOptions& options = side.prepared->geometry->options;
    const int window = window_for(options, view);
    if (side.store.window() != window) {
        side.store = {};
        side.store = clipmap::TileStore(window, memory_);
    }
    const double wider = wider_for(view, options);
    if (wider != side.wider) {
        side.painter.use(side.prepared, wider, memory_);
        side.store.forget();
        side.wider = wider;
    }
}

// World-space width as a function of the distance between camera and terrain (section 3). In steps: a camera that moves
// little keeps its tiles.
double Clipmap::wider_for(const View& view, const clipmap::ClipmapOptions& options) const {
    constexpr double steps_an_octave = 8.0;
    if (options.widen_from <= 0.0)
        return 1.0;
    const double farther = std::clamp(ground_distance(terrain_, eye_of(view)), options.widen_from,
                                      std::max(options.widen_from, options.widen_to)) /
                           options.widen_from;
    return std::exp2(std::round(steps_an_octave * std::log2(farther)) / steps_an_octave);
}

void Clipmap::set_place(const View& view, const GBufferView& gbuffer, gl::Program& program) const {
    program.use();
    program.set("position_texture", 0);
    gbuffer.position->bind(0);
    program.set("surface_texture", 1);
    gbuffer.surface->bind(1);
    const clipmap::ClipmapGeometry& geometry = *outside_.prepared->geometry;
    const double texel = geometry.texture.texel(finest_level);
    program.set("first_block", glm::ivec2(geometry.texture.first_block_x, geometry.texture.first_block_y));
    program.set("texels_per_block", static_cast<int>(std::lrint(view.positions.block_size / texel)));
    program.set("texels_per_metre", static_cast<float>(1.0 / texel));
    program.set("anisotropy", static_cast<float>(geometry.options.anisotropy));
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

void Clipmap::draw_tiles(const View& view, std::vector<Tile> needed, Side& side,
                         gl::ProgramLibrary& programs) {
    const gl::PassTimer timer(view.timings, "clipmap tiles");
    std::vector<Tile> missing = side.store.choose(std::move(needed));
    const auto budget = static_cast<size_t>(side.prepared->geometry->options.tiles_a_frame);
    if (budget > 0 && missing.size() > budget)
        missing.resize(budget);
    for (const Tile& tile : missing) {
        side.painter.draw(tile, side.store, programs);
        side.store.set_drawn(tile);
    }
    side.store.upload_table();
}

void Clipmap::draw(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    GLint target = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &target);
    // Samples of silhouettes see what the picture's pixels see: their tiles are there.
    if (!(in_areas_ && view.antialias == Antialias::none)) {
        std::vector<Tile> needed;
        {
            const gl::PassTimer timer(view.timings, "clipmap feedback");
            needed = needed_tiles(view, gbuffer, programs);
        }
        if (inside_.prepared)
            draw_tiles(view, needed, inside_, programs);
        draw_tiles(view, std::move(needed), outside_, programs);
    }
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(target));
    glViewport(0, 0, gbuffer.position->width(), gbuffer.position->height());
    draw_side(view, gbuffer, LensSide::outside, programs);
    if (inside_.prepared)
        draw_side(view, gbuffer, LensSide::inside, programs);
    glDisable(GL_BLEND);
}

void Clipmap::draw_side(const View& view, const GBufferView& gbuffer, LensSide lens_side,
                        gl::ProgramLibrary& programs) {
    const Side& side = lens_side == LensSide::outside ? outside_ : inside_;
    gl::Flags flags;
    if (gbuffer.set_gathered)
        flags.insert("GATHERED");
    if (inside_.prepared)
        flags.insert("LENS");
    gl::Program& program = programs.get("clipmap", flags);
    set_place(view, gbuffer, program);
    program.set("tiles", 2);
    side.store.texels().bind(2);
    program.set("table", 3);
    side.store.table().bind(3);
    program.set("window", side.store.window());
    if (inside_.prepared) {
        program.set("lens_side", static_cast<int>(lens_side));
        program.set("lens_texture", 4);
        gbuffer.lens->bind(4);
    }
    if (gbuffer.set_gathered)
        gbuffer.set_gathered(program);
    if (view.has_below || lens_side == LensSide::inside) {
        glEnable(GL_BLEND);
        glBlendFunc(GL_ONE, view.has_below ? GL_ONE_MINUS_SRC_ALPHA : GL_ONE);
    }
    no_vertices_.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void Clipmap::draw_ids(const View&, const GBufferView&, gl::ProgramLibrary&) {
    throw Error(ErrorKind::unsupported,
                "technique 'clipmap' keeps colours alone and knows no ids; draw the layer with technique "
                "'static' instead");
}

}  // namespace decalgl

// Drawing out of the tiles of the screen.
#include <utility>

#include "gl/gl.h"
#include "gl/texture.h"
#include "technique/dynamic_lines/bins.h"
#include "technique/dynamic_lines/bins_layout.h"

namespace decalgl {

namespace {

// Beyond those of frame's own programs, and of looks and ground.
constexpr GLuint half_planes_unit = 8;
constexpr GLuint arcs_unit = 11;

}  // namespace

void LineBins::bind(gl::Program& program, const View& view, const GBufferView& gbuffer,
                    const LineLooks& looks) const {
    const std::pair<const char*, const gl::TextureBuffer*> buffers[] = {{"tile_list", &list_},
                                                                        {"segment_ends", &ends_},
                                                                        {"segment_joints", &joints_},
                                                                        {"tile_places", &places_}};
    int unit = 0;
    for (const auto& [name, buffer] : buffers) {
        program.set(name, unit);
        buffer->bind(static_cast<GLuint>(unit++));
    }
    looks.bind(program, 4);
    program.set("surface_texture", 5);
    gbuffer.surface->bind(5);
    if (looks.has_lens()) {
        program.set("lens_texture", 6);
        gbuffer.lens->bind(6);
    }
    if (half_planes_) {
        program.set("half_planes", static_cast<int>(half_planes_unit));
        half_planes_.bind(half_planes_unit);
    }
    bind_ground(program, *ground_, view);
    if (arcs_) {
        program.set("segment_arcs", static_cast<int>(arcs_unit));
        arcs_.bind(arcs_unit);
    }
    program.set("tile_grid", grid_);
    program.set("run_count", static_cast<int>(run_count_));
}

void LineBins::draw_tiles(gl::Flags flags, const View& view, const GBufferView& gbuffer,
                          const LineLooks& looks, gl::ProgramLibrary& programs) const {
    for (const std::string& flag : looks.flags())
        flags.insert(flag);
    if (looks.summary().has_sides)
        flags.insert("SIDES");
    const bool is_gathered = static_cast<bool>(gbuffer.set_gathered);
    gl::Program& program = programs.get(is_gathered ? "dynamic_bins_gathered" : "dynamic_bins", flags);
    program.use();
    bind(program, view, gbuffer, looks);
    no_vertices_.bind();
    if (is_gathered) {
        gbuffer.set_gathered(program);
        glDrawArrays(GL_TRIANGLES, 0, 3);
        return;
    }
    const glm::ivec2 blocks = (grid_ + BLOCK_TILES - 1) / BLOCK_TILES;
    program.set("block_grid", blocks);
    program.set("drawn_size", glm::ivec2(gbuffer.surface->width(), gbuffer.surface->height()));
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, blocks.x * blocks.y);
}

void LineBins::draw(const View& view, const GBufferView& gbuffer, const LineLooks& looks,
                    gl::ProgramLibrary& programs) const {
    if (view.has_below) {
        glEnable(GL_BLEND);
        glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    } else {
        const float nothing[4] = {0.0F, 0.0F, 0.0F, 0.0F};
        glClearBufferfv(GL_COLOR, 0, nothing);
    }
    if (entry_count_ > 0) {
        gl::Flags flags;
        const LineSummary& summary = looks.summary();
        if (view.antialias == Antialias::coverage)
            flags.insert("COVERAGE");
        if (summary.has_translucency)
            flags.insert("TRANSLUCENT");
        else if (summary.has_one_look)
            flags.insert("UNION");
        draw_tiles(std::move(flags), view, gbuffer, looks, programs);
    }
    glDisable(GL_BLEND);
}

void LineBins::draw_ids(const View& view, const GBufferView& gbuffer, const LineLooks& looks,
                        gl::ProgramLibrary& programs) const {
    const GLuint nothing[4] = {0, 0, 0, 0};
    glClearBufferuiv(GL_COLOR, 0, nothing);
    if (entry_count_ > 0)
        draw_tiles({"IDS"}, view, gbuffer, looks, programs);
}

}  // namespace decalgl

#include "technique/static_decals/static_decals.h"

#include <cmath>
#include <utility>

#include "gl/gl.h"
#include "gl/texture.h"

namespace decalgl {

std::unique_ptr<const Prepared> StaticDecals::preprocess(const TechniqueInput& input,
                                                         Progress& progress) const {
    return build_decals(input, progress);
}

std::unique_ptr<const Prepared> StaticDecals::open(const ArchiveReader& archive, const std::string& prefix,
                                                   const MemoryAccount&) const {
    return open_decals(archive, prefix);
}

void StaticDecals::upload(std::shared_ptr<const Prepared> prepared, const MemoryAccount& memory) {
    prepared_ = std::static_pointer_cast<const PreparedDecals>(std::move(prepared));
    cell_starts_ = gl::TextureBuffer::from(memory, "static: cells", GL_R32UI, prepared_->cell_starts.span());
    cell_texels_ = gl::TextureBuffer::from(memory, "static: pieces", GL_RG32UI, prepared_->texels.span());
    styles_ = gl::TextureBuffer::from(memory, "static: styles", GL_RG32UI, prepared_->styles.span());
    no_vertices_ = gl::VertexArray::create();
}

UpdateReport StaticDecals::update(const View&) {
    UpdateReport report;
    report.pieces = prepared_->pieces;
    report.bytes = cell_starts_.buffer().bytes() + cell_texels_.buffer().bytes() + styles_.buffer().bytes();
    report.longest_walk = prepared_->longest_cell;
    return report;
}

void StaticDecals::draw(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    gl::Flags flags;
    if (prepared_->has_translucency)
        flags.insert("TRANSLUCENT");
    if (view.antialias == Antialias::coverage)
        flags.insert("COVERAGE");
    draw_full_screen(std::move(flags), view, gbuffer, programs);
}

void StaticDecals::draw_ids(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    draw_full_screen({"IDS"}, view, gbuffer, programs);
}

void StaticDecals::draw_full_screen(gl::Flags flags, const View& view, const GBufferView& gbuffer,
                                    gl::ProgramLibrary& programs) {
    const bool one_width = prepared_->has_lines && prepared_->narrowest == prepared_->widest;
    if (prepared_->has_lines)
        flags.insert("LINES");
    if (one_width)
        flags.insert("ONE_WIDTH");
    if (prepared_->has_polygons)
        flags.insert("RINGS");
    gl::Program& program = programs.get("static_decals", flags);
    const CellGrid& grid = prepared_->grid;
    program.use();
    program.set("position_texture", 0);
    gbuffer.position->bind(0);
    if (flags.count("COVERAGE") != 0) {
        program.set("surface_texture", 1);
        gbuffer.surface->bind(1);
    }
    program.set("cell_starts", 2);
    cell_starts_.bind(2);
    program.set("cell_texels", 3);
    cell_texels_.bind(3);
    program.set("decal_styles", 4);
    styles_.bind(4);
    program.set("cell_shift",
                static_cast<int>(std::lrint(std::log2(grid.cell_size / view.positions.block_size))));
    program.set("quanta_per_metre", static_cast<float>(1.0 / grid.quantum));
    program.set("first_cell", glm::ivec2(grid.first_cell_x, grid.first_cell_y));
    program.set("grid_size", glm::ivec2(grid.columns, grid.rows));
    program.set("bucket_columns", grid.bucket_columns);
    if (one_width) {
        const float scale = std::ldexp(1.0F, -prepared_->largest_scale);
        program.set("line_scale", scale);
        program.set("line_half_width2", prepared_->widest * scale * prepared_->widest * scale);
    }
    no_vertices_.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace decalgl

#include "technique/clipmap/tile_painter.h"

#include <algorithm>
#include <cmath>

#include "gl/gl.h"

namespace decalgl::clipmap {
namespace {

gl::VertexArray array_of(const gl::Buffer& buffer, bool with_offsets) {
    gl::VertexArray array = gl::VertexArray::create();
    std::vector<gl::Attribute> attributes{{0, 2, GL_INT, 0, true}, {1, 1, GL_UNSIGNED_INT, 8, true}};
    if (with_offsets)
        attributes.push_back({2, 4, GL_FLOAT, 12});
    array.set_vertices(0, buffer, with_offsets ? sizeof(OffsetVertex) : sizeof(PlacedVertex), attributes);
    return array;
}

bool meets(const LatticeBox& box, int64_t left, int64_t bottom, int64_t side) {
    return box.min_x <= left + side && box.max_x >= left && box.min_y <= bottom + side && box.max_y >= bottom;
}

}  // namespace

TilePainter::TilePainter(const PreparedClipmap& prepared, const MemoryAccount& memory) {
    const auto span_of = [](const auto& array) { return Span(array.data(), array.size()); };
    static_assert(sizeof(ClipmapDecal) == 8, "a texel of RG32UI");
    decals_ = gl::TextureBuffer::from(memory, "clipmap: decals", GL_RG32UI, span_of(prepared.decals));
    fills_ = gl::Buffer::from(memory, "clipmap: vertices", span_of(prepared.fills));
    lines_ = gl::Buffer::from(memory, "clipmap: vertices", span_of(prepared.lines));
    mesh_ = gl::Buffer::from(memory, "clipmap: vertices", span_of(prepared.mesh));
    offsets_ = gl::Buffer::from(memory, "clipmap: vertices", span_of(prepared.offsets));
    fill_array_ = array_of(fills_, false);
    line_array_ = array_of(lines_, false);
    mesh_array_ = array_of(mesh_, false);
    offset_array_ = array_of(offsets_, true);
    const int samples = prepared.options.samples > 1 ? prepared.options.samples : 0;
    canvas_ =
        gl::Texture2D::create(memory, "clipmap: canvas", GL_RGBA8, tile_texels, tile_texels, 1, samples);
    canvas_framebuffer_ = gl::Framebuffer::create("tile", {{GL_COLOR_ATTACHMENT0, &canvas_}});
    GLuint layer = 0;
    glCreateFramebuffers(1, &layer);
    layer_framebuffer_ = gl::ObjectHandle(gl::ObjectType::framebuffer, layer);
}

size_t TilePainter::bytes() const {
    return decals_.buffer().bytes() + fills_.bytes() + lines_.bytes() + mesh_.bytes() + offsets_.bytes() +
           canvas_.bytes();
}

// Algorithm 2: thin lines are drawn as lines, whatever draws the others. `texels`: the line's width.
TilePainter::Form TilePainter::form_of(const PreparedClipmap& prepared, const Chunk& chunk, double texels) {
    if (!chunk.is_stroke)
        return Form::fill;
    const bool thin = texels < prepared.options.thin_below;
    switch (prepared.options.solution) {
        case LineSolution::primitives:
            return Form::line;
        case LineSolution::polygons:
            return Form::mesh;
        case LineSolution::both:
            return thin ? Form::line : Form::mesh;
        case LineSolution::wireframe:
            return thin ? Form::wire : Form::mesh;
        case LineSolution::geometry:
            return thin ? Form::line : Form::adjacent;
        case LineSolution::offsets:
        case LineSolution::polar_offsets:
            break;
    }
    return thin ? Form::thin_offsets : Form::offsets;
}

VertexRange TilePainter::range_of(const Chunk& chunk, Form form) {
    switch (form) {
        case Form::fill:
            return chunk.fill;
        case Form::line:
            return chunk.line;
        case Form::mesh:
        case Form::wire:
            return chunk.mesh;
        case Form::adjacent:
            return {chunk.line.first - 1, chunk.line.count + 2};
        case Form::offsets:
        case Form::thin_offsets:
            break;
    }
    return chunk.offsets;
}

void TilePainter::draw(const PreparedClipmap& prepared, const Tile& tile, const TileStore& store,
                       gl::ProgramLibrary& programs) {
    canvas_framebuffer_.clear_color(0, 0.0F, 0.0F, 0.0F, 0.0F);
    canvas_framebuffer_.bind();
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    const int64_t side = int64_t{1} << (lattice_bits - tile.level);
    const double texel = prepared.texture.texel(tile.level);
    Form form = Form::fill;
    double texels = 0.0;
    firsts_.clear();
    counts_.clear();
    for (const Chunk& chunk : prepared.chunks) {
        if (!meets(chunk.box, tile.x * side, tile.y * side, side))
            continue;
        const double own_texels = 2.0 * static_cast<double>(prepared.decals[chunk.decal].half_width) / texel;
        const Form own = form_of(prepared, chunk, own_texels);
        if (!firsts_.empty() && (own != form || own_texels != texels))
            draw_run(prepared, form, texels, tile, programs);
        form = own;
        texels = own_texels;
        const VertexRange range = range_of(chunk, own);
        firsts_.push_back(range.first);
        counts_.push_back(range.count);
    }
    if (!firsts_.empty())
        draw_run(prepared, form, texels, tile, programs);
    glDisable(GL_BLEND);
    glNamedFramebufferTextureLayer(layer_framebuffer_.name(), GL_COLOR_ATTACHMENT0, store.texels().id(), 0,
                                   tile.level);
    const int x = store.texel_x(tile), y = store.texel_y(tile);
    glBlitNamedFramebuffer(canvas_framebuffer_.id(), layer_framebuffer_.name(), 0, 0, tile_texels,
                           tile_texels, x, y, x + tile_texels, y + tile_texels, GL_COLOR_BUFFER_BIT,
                           GL_NEAREST);
}

void TilePainter::draw_run(const PreparedClipmap& prepared, Form form, double texels, const Tile& tile,
                           gl::ProgramLibrary& programs) {
    const bool by_offsets = form == Form::offsets || form == Form::thin_offsets;
    const bool as_lines = form == Form::line || form == Form::wire || form == Form::thin_offsets;
    const char* name = form == Form::adjacent  ? "clipmap_adjacent"
                       : form == Form::offsets ? "clipmap_offsets"
                                               : "clipmap_tile";
    gl::Flags flags;
    if (form == Form::offsets && prepared.options.solution == LineSolution::polar_offsets)
        flags.insert("POLAR");
    gl::Program& program = programs.get(name, flags);
    program.use();
    program.set("clipmap_decals", 0);
    decals_.bind(0);
    const auto side = int64_t{1} << (lattice_bits - tile.level);
    program.set("tile_place",
                glm::ivec2(static_cast<int32_t>(tile.x * side), static_cast<int32_t>(tile.y * side)));
    program.set("clip_per_quantum", static_cast<float>(2.0 / static_cast<double>(side)));
    // Lines are a texel wide at least: thinner ones are fainter.
    program.set("opacity", static_cast<float>(as_lines ? std::min(1.0, texels) : 1.0));
    if (form == Form::adjacent || form == Form::offsets)
        program.set("clip_per_half_width", static_cast<float>(texels / tile_texels));
    if (form == Form::adjacent) {
        program.set("bevel_cosine", static_cast<float>(-std::cos(prepared.options.bevel_below *
                                                                 3.14159265358979323846 / 180.0)));
        program.set("inner_meets", prepared.options.inner_meets);
    }
    const double widest = form == Form::wire ? 1.0 : prepared.options.widest_line;
    glLineWidth(static_cast<GLfloat>(std::clamp(texels, 1.0, std::max(1.0, widest))));
    if (as_lines && prepared.options.samples == 1)
        glEnable(GL_LINE_SMOOTH);
    if (form == Form::wire)
        glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    const gl::VertexArray& array = form == Form::fill                           ? fill_array_
                                   : by_offsets                                 ? offset_array_
                                   : (form == Form::mesh || form == Form::wire) ? mesh_array_
                                                                                : line_array_;
    array.bind();
    const GLenum mode = form == Form::fill                           ? GL_TRIANGLES
                        : form == Form::adjacent                     ? GL_LINE_STRIP_ADJACENCY
                        : (form == Form::mesh || form == Form::wire) ? GL_TRIANGLE_STRIP
                                                                     : GL_LINE_STRIP;
    glMultiDrawArrays(mode, firsts_.data(), counts_.data(), static_cast<GLsizei>(firsts_.size()));
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glDisable(GL_LINE_SMOOTH);
    glLineWidth(1.0F);
    firsts_.clear();
    counts_.clear();
}

}  // namespace decalgl::clipmap

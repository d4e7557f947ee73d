#include "technique/clipmap/tile_painter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gl/gl.h"

namespace decalgl::clipmap {
namespace {

constexpr double pi = 3.14159265358979323846;

// Whether the box, made larger by `reach` on all sides, meets a square.
bool meets(const LatticeBox& box, double reach, int64_t left, int64_t bottom, int64_t side) {
    const auto meets_along = [&](int32_t low, int32_t high, int64_t from) {
        return double(low) - reach <= double(from + side) && double(high) + reach >= double(from);
    };
    return meets_along(box.min_x, box.max_x, left) && meets_along(box.min_y, box.max_y, bottom);
}

// How far a line reaches from its middle, in half widths: a joint by method 2 reaches farther than the line is wide.
double reach_of(const ClipmapOptions& options) {
    return 1.0 / std::max(0.02, std::sin(0.5 * options.bevel_below * pi / 180.0));
}

}  // namespace

template <typename Values>
void TilePainter::Vertices::upload(const Values& values, const MemoryAccount& memory) {
    using Vertex = typename Values::value_type;
    if (array && from == values.data())
        return;
    array = {};
    buffer = {};
    buffer = gl::Buffer::from(memory, "clipmap: vertices", Span(values.data(), values.size()));
    std::vector<gl::Attribute> attributes{{0, 2, GL_INT, 0, true}, {1, 1, GL_UNSIGNED_INT, 8, true}};
    if (sizeof(Vertex) == sizeof(OffsetVertex))
        attributes.push_back({2, 4, GL_FLOAT, 12});
    array = gl::VertexArray::create();
    array.set_vertices(0, buffer, sizeof(Vertex), attributes);
    from = values.data();
}

void TilePainter::use(std::shared_ptr<const PreparedClipmap> prepared, double wider,
                      const MemoryAccount& memory) {
    const ClipmapGeometry& geometry = *prepared->geometry;
    const bool is_anew = wider != 1.0 && geometry.is_tessellated_anew();
    if (!is_anew)
        tessellation_ = prepared->tessellation;
    else if (prepared_ != prepared || wider_ != wider)
        tessellation_ = tessellate(geometry, prepared->looks, wider, memory);
    if (prepared_ != prepared) {
        decals_ = {};
        decals_ = gl::TextureBuffer::from(memory, "clipmap: decals", GL_RG32UI,
                                          Span(prepared->looks.data(), prepared->looks.size()));
    }
    prepared_ = std::move(prepared);
    wider_ = wider;
    fills_.upload(geometry.fills, memory);
    if (geometry.draws_lines())
        lines_.upload(geometry.lines, memory);
    mesh_.upload(tessellation_.mesh, memory);
    offsets_.upload(tessellation_.offsets, memory);
    if (canvas_.width() == 0)
        make_canvas(memory);
}

void TilePainter::make_canvas(const MemoryAccount& memory) {
    const int chosen = prepared_->geometry->options.samples;
    canvas_ = gl::Texture2D::create(memory, "clipmap: canvas", GL_RGBA8, tile_texels, tile_texels, 1,
                                    chosen > 1 ? chosen : 0);
    canvas_framebuffer_ = gl::Framebuffer::create("tile", {{GL_COLOR_ATTACHMENT0, &canvas_}});
    GLuint layer = 0;
    glCreateFramebuffers(1, &layer);
    layer_framebuffer_ = gl::ObjectHandle(gl::ObjectType::framebuffer, layer);
}

size_t TilePainter::bytes() const {
    return decals_.buffer().bytes() + fills_.buffer.bytes() + lines_.buffer.bytes() + mesh_.buffer.bytes() +
           offsets_.buffer.bytes() + canvas_.bytes();
}

// Algorithm 2: thin lines are drawn as lines, whatever draws the others. `texels`: the line's width.
TilePainter::Form TilePainter::form_of(const Chunk& chunk, double texels) const {
    if (!chunk.is_stroke)
        return Form::fill;
    const ClipmapOptions& options = prepared_->geometry->options;
    const bool thin = texels < options.thin_below;
    switch (options.solution) {
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

VertexRange TilePainter::range_of(size_t i, Form form) const {
    const Chunk& chunk = prepared_->geometry->chunks[i];
    switch (form) {
        case Form::fill:
            return chunk.fill;
        case Form::line:
            return chunk.line;
        case Form::mesh:
        case Form::wire:
            return {2 * tessellation_.pairs[i].first, 2 * tessellation_.pairs[i].count};
        case Form::adjacent:
            return {chunk.line.first - 1, chunk.line.count + 2};
        case Form::offsets:
        case Form::thin_offsets:
            break;
    }
    return tessellation_.pairs[i];
}

const TilePainter::Vertices& TilePainter::vertices_of(Form form) const {
    switch (form) {
        case Form::fill:
            return fills_;
        case Form::mesh:
        case Form::wire:
            return mesh_;
        case Form::offsets:
        case Form::thin_offsets:
            return offsets_;
        case Form::line:
        case Form::adjacent:
            break;
    }
    return lines_;
}

void TilePainter::draw(const Tile& tile, const TileStore& store, gl::ProgramLibrary& programs) {
    canvas_framebuffer_.clear_color(0, 0.0F, 0.0F, 0.0F, 0.0F);
    canvas_framebuffer_.bind();
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    const ClipmapGeometry& geometry = *prepared_->geometry;
    const int64_t side = int64_t{1} << (lattice_bits - tile.level);
    const double texel = geometry.texture.texel(tile.level);
    const double reach = wider_ * reach_of(geometry.options) / geometry.texture.quantum();
    Form form = Form::fill;
    double texels = 0.0;
    firsts_.clear();
    counts_.clear();
    for (const uint32_t i : prepared_->drawn) {
        const Chunk& chunk = geometry.chunks[i];
        const auto half_width = static_cast<double>(prepared_->looks[chunk.decal].half_width);
        if (!meets(chunk.box, reach * half_width + 1.0, tile.x * side, tile.y * side, side))
            continue;
        const double own_texels = 2.0 * wider_ * half_width / texel;
        const Form own = form_of(chunk, own_texels);
        if (!firsts_.empty() && (own != form || own_texels != texels))
            draw_run(form, texels, tile, programs);
        form = own;
        texels = own_texels;
        const VertexRange range = range_of(i, own);
        firsts_.push_back(range.first);
        counts_.push_back(range.count);
    }
    if (!firsts_.empty())
        draw_run(form, texels, tile, programs);
    glDisable(GL_BLEND);
    glNamedFramebufferTextureLayer(layer_framebuffer_.name(), GL_COLOR_ATTACHMENT0, store.texels().id(), 0,
                                   tile.level);
    const int x = store.texel_x(tile), y = store.texel_y(tile);
    glBlitNamedFramebuffer(canvas_framebuffer_.id(), layer_framebuffer_.name(), 0, 0, tile_texels,
                           tile_texels, x, y, x + tile_texels, y + tile_texels, GL_COLOR_BUFFER_BIT,
                           GL_NEAREST);
}

void TilePainter::draw_run(Form form, double texels, const Tile& tile, gl::ProgramLibrary& programs) {
    const ClipmapOptions& options = prepared_->geometry->options;
    const bool as_lines = form == Form::line || form == Form::wire || form == Form::thin_offsets;
    const char* name = form == Form::adjacent  ? "clipmap_adjacent"
                       : form == Form::offsets ? "clipmap_offsets"
                                               : "clipmap_tile";
    gl::Flags flags;
    if (form == Form::offsets && options.solution == LineSolution::polar_offsets)
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
        program.set("bevel_cosine", static_cast<float>(-std::cos(options.bevel_below * pi / 180.0)));
        program.set("inner_meets", options.joints == JointMethod::inner_meets);
        program.set("has_joints", options.joints != JointMethod::none);
    }
    const double widest = form == Form::wire ? 1.0 : options.widest_line;
    glLineWidth(static_cast<GLfloat>(std::clamp(texels, 1.0, std::max(1.0, widest))));
    if (as_lines && options.samples == 1)
        glEnable(GL_LINE_SMOOTH);
    if (form == Form::wire)
        glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    vertices_of(form).array.bind();
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

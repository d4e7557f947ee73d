#include "technique/distance_field/distance_field.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include "decalgl/core/error.h"
#include "gl/gl.h"
#include "gl/pass_timer.h"
#include "shared/view_block.h"
#include "technique/distance_field/drop_offs.h"

namespace decalgl {
namespace {

using namespace network;

// Around boxes, in pixels: what coverage looks at beyond a field, and what rasterisers round.
constexpr double spare_pixels = 2.0;
constexpr uint32_t most_ordered = 1U << 23U;  // features whose order a float32 depth tells apart, twice

// Unit 7 is that of gathered pixels.
enum Unit : int {
    position_unit,
    surface_unit,
    styles_unit,
    nodes_unit,
    slots_unit,
    drop_offs_unit,
    lod_unit,
    lens_unit = 8,
    cross_unit,
    length_unit,
    depth_unit,
    rasters_unit,
    drawn_positions_unit,
    drawn_surfaces_unit
};

gl::Texture2D make_rasters(const std::vector<NetworkRaster>& rasters, const MemoryAccount& memory) {
    if (rasters.empty())
        return {};
    const NetworkRaster& first = rasters.front();
    gl::Texture2D texture =
        gl::Texture2D::create_array(memory, "distance_field: rasters", GL_RGBA8, first.width, first.height,
                                    static_cast<int>(rasters.size()));
    for (size_t i = 0; i < rasters.size(); ++i)
        texture.update_layer(static_cast<int>(i), rasters[i].texels.data());
    texture.set_filter(GL_LINEAR, GL_LINEAR);
    texture.set_wrap(GL_REPEAT, GL_CLAMP_TO_EDGE);
    return texture;
}

gl::Texture2D make_lod(const LevelOfDetail& lod, const MemoryAccount& memory) {
    const bool is_texture = lod.source == LodSource::texture;
    gl::Texture2D texture = gl::Texture2D::create(memory, "distance_field: levels of detail", GL_R8,
                                                  is_texture ? lod.width : 1, is_texture ? lod.height : 1);
    const uint8_t nothing = 0;
    texture.update(0, 0, 0, texture.width(), texture.height(), is_texture ? lod.texels.data() : &nothing);
    texture.set_filter(GL_LINEAR, GL_LINEAR);
    return texture;
}

// x, y of the lower left corner, as the shader sees places, and one by width and height.
glm::vec4 lod_extent(const LevelOfDetail& lod, const View& view) {
    glm::dvec2 low(lod.extent[0], lod.extent[1]);
    const glm::dvec2 size(lod.extent[2] - lod.extent[0], lod.extent[3] - lod.extent[1]);
    if (lod.space == LodSpace::map) {
        const ViewBlock& block = *view.block;
        low.x -=
            view.positions.origin_x + block.base_block.x * view.positions.block_size + block.base_offset.x;
        low.y -=
            view.positions.origin_y + block.base_block.y * view.positions.block_size + block.base_offset.y;
    }
    return {low.x, low.y, 1.0 / size.x, 1.0 / size.y};
}

}  // namespace

std::unique_ptr<const Prepared> DistanceField::preprocess(const TechniqueInput& input,
                                                          Progress& progress) const {
    return prepare_network(input, progress);
}

std::unique_ptr<const Prepared> DistanceField::open(const ArchiveReader&, const std::string&,
                                                    const MemoryAccount&) const {
    throw Error(ErrorKind::unsupported, "technique 'distance_field' is not kept on disk");
}

void DistanceField::NetworkBuffers::upload(const std::shared_ptr<const Network>& from,
                                           const MemoryAccount& memory) {
    network = from;
    nodes = gl::TextureBuffer::from(memory, "distance_field: nodes", GL_RGB32I,
                                    Span<const Node>(from->nodes.data(), from->nodes.size()));
    segments = gl::Buffer::from(memory, "distance_field: segments",
                                Span<const Segment>(from->segments.data(), from->segments.size()));
    points = gl::VertexArray::create();
    points.set_vertices(0, segments, sizeof(Segment),
                        {{0, 4, GL_UNSIGNED_INT, 0, true, false}, {1, 2, GL_UNSIGNED_INT, 16, true, false}});
}

size_t DistanceField::Side::bytes() const {
    return buffers->bytes() + slots.buffer().bytes() + styles.buffer().bytes() + drop_offs.bytes() +
           rasters.bytes() + lod.bytes();
}

void DistanceField::upload_side(std::shared_ptr<const Prepared> prepared, Side& side) const {
    auto own = std::static_pointer_cast<const PreparedNetwork>(std::move(prepared));
    if (own->table.slots.size() >= most_ordered)
        throw Error(ErrorKind::unsupported, "technique 'distance_field' draws at most " +
                                                std::to_string(most_ordered - 1) + " features");
    if (!side.buffers || side.buffers->network != own->network) {
        side.buffers = std::make_shared<NetworkBuffers>();
        side.buffers->upload(own->network, memory_);
    }
    if (side.prepared == own)
        return;
    const CategoryTable& table = own->table;
    side.slots = gl::TextureBuffer::from(memory_, "distance_field: slots", GL_RG32UI, table.slots);
    side.styles = gl::TextureBuffer::from(memory_, "distance_field: styles", GL_RGBA32F, table.texels);
    if (!side.prepared || side.prepared->options != own->options || !side.drop_offs) {
        side.drop_offs = make_drop_offs(*own->options, memory_);
        side.lod = make_lod(own->options->lod, memory_);
    }
    side.rasters = make_rasters(table.rasters, memory_);
    side.prepared = std::move(own);
}

void DistanceField::upload(std::shared_ptr<const Prepared> prepared, std::shared_ptr<const Prepared> lens,
                           const TerrainView&, const MemoryAccount& memory) {
    memory_ = memory;
    try {
        upload_side(std::move(prepared), outside_);
        if (!lens) {
            inside_ = {};
        } else {
            inside_.buffers = outside_.buffers;
            upload_side(std::move(lens), inside_);
        }
    } catch (...) {
        outside_ = {};
        inside_ = {};
        throw;
    }
    if (!no_vertices_)
        no_vertices_ = gl::VertexArray::create();
}

UpdateReport DistanceField::update(const View&) {
    drawn_.prepared = nullptr;
    UpdateReport report;
    report.pieces = outside_.prepared->network->segments.size();
    report.bytes = outside_.bytes() + targets_.bytes();
    if (inside_.prepared)
        report.bytes +=
            inside_.bytes() - (inside_.buffers == outside_.buffers ? inside_.buffers->bytes() : 0);
    report.counts = {{"categories", static_cast<double>(outside_.prepared->table.categories.size())},
                     {"field_bytes", static_cast<double>(targets_.bytes())}};
    return report;
}

SlopeUse DistanceField::slope_use() const {
    const auto has_slopes = [](const Side& side) { return side.prepared && side.prepared->table.slopes; };
    return has_slopes(outside_) || has_slopes(inside_) ? SlopeUse::widths : SlopeUse::none;
}

gl::Flags DistanceField::flags_of(const Side& side) const {
    const DistanceFieldOptions& options = *side.prepared->options;
    const CategoryTable& table = side.prepared->table;
    gl::Flags flags;
    const auto add_if = [&](bool wanted, const char* flag) {
        if (wanted)
            flags.insert(flag);
    };
    add_if(options.widths_at == LodPlace::vertex, "VERTEX_WIDTHS");
    add_if(table.slopes, "SLOPES");
    add_if(inside_.prepared != nullptr, "LENS");
    return flags;
}

FieldFormat DistanceField::format_for(const Side& side, const View& view, const GBufferView& gbuffer) const {
    const DistanceFieldOptions& options = *side.prepared->options;
    FieldFormat format;
    format.width = gbuffer.position->width();
    format.height = gbuffer.position->height();
    format.layers = static_cast<int>(side.prepared->table.categories.size());
    format.bits = options.bits;
    format.angles = view.antialias == Antialias::coverage;
    format.lengths = side.prepared->table.lengths;
    format.depths = options.keep_depth;
    format.nearest = options.blending == FieldBlending::nearest;
    return format;
}

void DistanceField::set_styles(const Side& side, const View& view, const GBufferView& gbuffer,
                               gl::Program& program) const {
    const LevelOfDetail& lod = side.prepared->options->lod;
    program.set("position_texture", position_unit);
    gbuffer.position->bind(position_unit);
    program.set("surface_texture", surface_unit);
    gbuffer.surface->bind(surface_unit);
    program.set("network_styles", styles_unit);
    side.styles.bind(styles_unit);
    program.set("lod_source", static_cast<int>(lod.source));
    program.set("lod_space", static_cast<int>(lod.space));
    program.set("lod_value", static_cast<float>(lod.value));
    program.set("lod_range", glm::vec2(lod.near, lod.far));
    program.set("lod_extent", lod_extent(lod, view));
    program.set("lod_texture", lod_unit);
    side.lod.bind(lod_unit);
    if (inside_.prepared) {
        program.set("lens_texture", lens_unit);
        gbuffer.lens->bind(lens_unit);
    }
}

void DistanceField::draw_boxes(const Side& side, const gl::Flags& flags, const View& view,
                               const GBufferView& gbuffer, gl::ProgramLibrary& programs,
                               LensSide lens_side) const {
    const Network& network = *side.prepared->network;
    const HeightRanges& ranges = *side.prepared->ranges;
    gl::Program& program = programs.get("distance_field", flags);
    program.use();
    set_styles(side, view, gbuffer, program);
    program.set("network_nodes", nodes_unit);
    side.buffers->nodes.bind(nodes_unit);
    program.set("network_slots", slots_unit);
    side.slots.bind(slots_unit);
    program.set("drop_offs", drop_offs_unit);
    side.drop_offs.bind(drop_offs_unit);
    program.set("block_shift", network.lattice.block_shift);
    program.set("quantum", static_cast<float>(network.lattice.quantum));
    program.set("widest", static_cast<float>(side.prepared->table.reach));
    program.set("spare_pixels", static_cast<float>(spare_pixels + view.terrain_error));
    program.set("height_steps", glm::vec2(ranges.lowest(), ranges.step()));
    if (flags.count("IDS") != 0) {
        // Main colours lie over all borders, but where categories lie over each other with their borders.
        const auto features = static_cast<int>(side.prepared->table.slots.size());
        const bool is_over = side.prepared->options->borders == Borders::over;
        program.set("order_count", static_cast<float>(2 * features + 1));
        program.set("main_order", is_over ? 0 : features);
        if (flags.count("LENS") != 0)
            program.set("lens_side", static_cast<int>(lens_side));
    }
    const ViewBlock& block = *view.block;
    glViewport(-block.picture.x, -block.picture.y, view.width, view.height);
    glEnable(GL_DEPTH_CLAMP);
    glEnable(GL_CULL_FACE);
    glCullFace(GL_FRONT);
    side.buffers->points.bind();
    glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(network.segments.size()));
    glDisable(GL_CULL_FACE);
    glDisable(GL_DEPTH_CLAMP);
}

// Of the latest update: those of a recolour and of a lens with other colours alone are there already.
bool DistanceField::holds_fields(const Side& side) const {
    return drawn_.prepared && drawn_.prepared->network == side.prepared->network &&
           drawn_.prepared->options == side.prepared->options &&
           same_fields(drawn_.prepared->table, side.prepared->table);
}

void DistanceField::draw_fields(const Side& side, const View& view, const GBufferView& gbuffer,
                                gl::ProgramLibrary& programs) {
    const FieldFormat format = format_for(side, view, gbuffer);
    if (targets_.format() == format && holds_fields(side) &&
        std::memcmp(&drawn_.block, view.block, sizeof(ViewBlock)) == 0)
        return;
    const gl::PassTimer timer(view.timings, "fields");
    drawn_.prepared = nullptr;
    if (!(targets_.format() == format)) {
        targets_ = {};  // both at once may not fit
        targets_ = FieldTargets(format, memory_);
    }
    gl::Flags flags = flags_of(side);
    flags.erase("LENS");
    const auto add_if = [&](bool wanted, const char* flag) {
        if (wanted)
            flags.insert(flag);
    };
    add_if(side.prepared->options->drop_off == DropOff::exact, "EXACT");
    add_if(format.lengths, "LENGTHS");
    add_if(format.lengths && format.bits == 8, "PHASES");
    add_if(format.depths, "DEPTHS");
    add_if(format.angles, "ANGLES");
    add_if(format.nearest, "NEAREST");
    targets_.begin();
    if (format.nearest) {
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_LESS);
    } else {
        glEnable(GL_BLEND);
        glBlendEquation(GL_MIN);
    }
    draw_boxes(side, flags, view, gbuffer, programs, LensSide::outside);
    glBlendEquation(GL_FUNC_ADD);
    glDisable(GL_BLEND);
    glDepthFunc(GL_GREATER);
    glDisable(GL_DEPTH_TEST);
    drawn_.prepared = side.prepared;
    drawn_.block = *view.block;
}

void DistanceField::stylize(const Side& side, const View& view, const GBufferView& gbuffer,
                            gl::ProgramLibrary& programs, LensSide lens_side) {
    const gl::PassTimer timer(view.timings, "stylize");
    const FieldFormat& format = targets_.format();
    const DistanceFieldOptions& options = *side.prepared->options;
    gl::Flags flags = flags_of(side);
    const auto add_if = [&](bool wanted, const char* flag) {
        if (wanted)
            flags.insert(flag);
    };
    const bool is_gathered = static_cast<bool>(gbuffer.set_gathered);
    add_if(format.angles && !is_gathered, "COVERAGE");
    add_if(is_gathered, "GATHERED");
    add_if(format.lengths, "LENGTHS");
    add_if(format.lengths && format.bits == 8, "PHASES");
    add_if(format.depths, "DEPTHS");
    add_if(options.borders == Borders::under, "UNDER");
    add_if(options.borders == Borders::smooth, "SMOOTH");
    gl::Program& program = programs.get("distance_field_style", flags);
    program.use();
    set_styles(side, view, gbuffer, program);
    program.set("category_count", format.layers);
    program.set("cross_fields", cross_unit);
    targets_.cross.bind(cross_unit);
    if (format.lengths) {
        program.set("length_fields", length_unit);
        targets_.length.bind(length_unit);
        program.set("rasters", rasters_unit);
        (side.rasters ? side.rasters : side.drop_offs).bind(rasters_unit);
    }
    if (format.depths) {
        program.set("depth_fields", depth_unit);
        targets_.depth.bind(depth_unit);
    }
    if (flags.count("LENS") != 0)
        program.set("lens_side", static_cast<int>(lens_side));
    if (is_gathered) {
        gbuffer.set_gathered(program);
        program.set("drawn_positions", drawn_positions_unit);
        drawn_.position->bind(drawn_positions_unit);
        program.set("drawn_surfaces", drawn_surfaces_unit);
        drawn_.surface->bind(drawn_surfaces_unit);
    }
    no_vertices_.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void DistanceField::draw(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    GLint target = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &target);
    const GLfloat nothing[] = {0.0F, 0.0F, 0.0F, 0.0F};
    if (!view.has_below)
        glClearBufferfv(GL_COLOR, 0, nothing);
    const bool is_gathered = static_cast<bool>(gbuffer.set_gathered);
    if (!is_gathered) {
        drawn_.position = gbuffer.position;
        drawn_.surface = gbuffer.surface;
    }
    const auto draw_side = [&](const Side& side, LensSide lens_side) {
        if (!side.prepared->shows_anything())
            return;
        // Gathered texels read the fields that are there; with a lens, those are the other side's.
        if (!is_gathered)
            draw_fields(side, view, gbuffer, programs);
        else if (inside_.prepared)
            draw_fields_again(side, view, gbuffer, programs);
        glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(target));
        glViewport(0, 0, gbuffer.position->width(), gbuffer.position->height());
        glEnable(GL_BLEND);
        glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
        stylize(side, view, gbuffer, programs, lens_side);
        glDisable(GL_BLEND);
    };
    draw_side(outside_, LensSide::outside);
    if (inside_.prepared)
        draw_side(inside_, LensSide::inside);
}

// Over the picture from which texels were gathered, as it was drawn with coverage.
void DistanceField::draw_fields_again(const Side& side, const View& view, const GBufferView& gathered,
                                      gl::ProgramLibrary& programs) {
    View whole = view;
    whole.antialias = Antialias::coverage;
    GBufferView drawn = gathered;
    drawn.position = drawn_.position;
    drawn.surface = drawn_.surface;
    const bool has_scissor = glIsEnabled(GL_SCISSOR_TEST) == GL_TRUE;
    glDisable(GL_SCISSOR_TEST);
    draw_fields(side, whole, drawn, programs);
    if (has_scissor)
        glEnable(GL_SCISSOR_TEST);
}

// Into a picture of its own, whose depth keeps the topmost feature.
void DistanceField::draw_ids(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    GLint target = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &target);
    const int width = gbuffer.position->width(), height = gbuffer.position->height();
    const gl::Texture2D ids = gl::Texture2D::create(memory_, "distance_field: ids", GL_R32UI, width, height);
    const gl::Texture2D depth =
        gl::Texture2D::create(memory_, "distance_field: ids", GL_DEPTH_COMPONENT32F, width, height);
    const gl::Framebuffer framebuffer = gl::Framebuffer::create(
        "ids of a network", {{GL_COLOR_ATTACHMENT0, &ids}, {GL_DEPTH_ATTACHMENT, &depth}});
    framebuffer.clear_color_uint(0, 0);
    framebuffer.clear_depth(0.0F);
    framebuffer.bind();
    glEnable(GL_DEPTH_TEST);
    const auto draw_side = [&](const Side& side, LensSide lens_side) {
        gl::Flags flags = flags_of(side);
        flags.insert({"IDS", "EXACT"});
        if (side.prepared->shows_anything())
            draw_boxes(side, flags, view, gbuffer, programs, lens_side);
    };
    draw_side(outside_, LensSide::outside);
    if (inside_.prepared)
        draw_side(inside_, LensSide::inside);
    glDisable(GL_DEPTH_TEST);
    glBlitNamedFramebuffer(framebuffer.id(), static_cast<GLuint>(target), 0, 0, width, height, 0, 0, width,
                           height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(target));
    glViewport(0, 0, width, height);
}

}  // namespace decalgl

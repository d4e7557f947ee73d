#include "technique/loops/loops.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include "decalgl/core/error.h"
#include "gl/gl.h"
#include "gl/texture.h"
#include "shared/view_block.h"
#include "technique/view_base.h"

namespace decalgl {
namespace {

using loops::LoopsIndex;

[[noreturn]] void refuse_files() {
    throw Error(ErrorKind::unsupported,
                "layers of technique 'loops' are not kept on disk; prepare the scene anew, or use technique "
                "'static'");
}

[[noreturn]] void refuse_changes() {
    throw Error(ErrorKind::unsupported,
                "layers of technique 'loops' stay as they were prepared, but for their level of "
                "detail; use technique 'static' to restyle or edit them");
}

// The camera of the view, out of what all passes are told of it.
DetailEye detail_eye_of(const View& view) {
    const ViewBlock& block = *view.block;
    DetailEye eye;
    eye.eye = eye_of(view);
    for (int axis = 0; axis < 3; ++axis)
        eye.forward[size_t(axis)] = double{block.forward[axis]};
    const auto step = double{glm::length(glm::vec3(block.ray_direction_dy))};
    eye.pixels = step > 0.0 ? 1.0 / step : 0.0;
    eye.corner = 1.0 / std::hypot(1.0, 0.5 * step * std::hypot(double(view.width), double(view.height)));
    eye.metres_per_pixel = step > 0.0 ? 0.0 : double{glm::length(glm::vec3(block.ray_origin_dy))};
    return eye;
}

constexpr float no_bound = 3e38F;
constexpr DecalRole decal_roles[] = {DecalRole::fill, DecalRole::stroke, DecalRole::casing};

}  // namespace

void loops::PreparedLoops::save(ArchiveWriter&, const std::string&) const {
    refuse_files();
}

// Looks stay as they were prepared.
LayerLook loops::PreparedLoops::look_of(uint32_t layer, size_t) const {
    LayerLook look;
    look.layer = layer;
    return look;
}

// With another level of detail; shares the index.
std::shared_ptr<const Prepared> loops::PreparedLoops::restyled(Span<const LayerLook> looks,
                                                               const MemoryAccount&) const {
    LoopsDetail detail = detail_;
    for (const LayerLook& look : looks) {
        const bool has_looks = std::any_of(
            std::begin(decal_roles), std::end(decal_roles),
            [&](DecalRole role) { return !look.of(role)->colors.empty() || !look.of(role)->widths.empty(); });
        if (has_looks || !look.draw_order.empty())
            refuse_changes();
        if (const auto* choice = dynamic_cast<const LoopsChoice*>(look.options.get()))
            detail = choice->detail;
    }
    validate(detail);
    return std::make_shared<PreparedLoops>(index_, detail);
}

std::shared_ptr<const Prepared> loops::PreparedLoops::edited(const LayerEdit&, const MemoryAccount&) const {
    refuse_changes();
}

std::unique_ptr<const Prepared> Loops::open(const ArchiveReader&, const std::string&,
                                            const MemoryAccount&) const {
    refuse_files();
}

std::unique_ptr<const Prepared> Loops::preprocess(const TechniqueInput& input, Progress& progress) const {
    return loops::build_loops(input, progress);
}

void Loops::upload(std::shared_ptr<const Prepared> prepared, std::shared_ptr<const Prepared>,
                   const TerrainView&, const MemoryAccount& memory) {
    prepared_ = std::static_pointer_cast<const loops::PreparedLoops>(std::move(prepared));
    if (uploaded_ == prepared_->index())
        return;
    uploaded_ = nullptr;
    buffers_.clear();
    const LoopsIndex& index = *prepared_->index();
    const auto add = [&](const char* name, GLenum format, const auto& values) {
        buffers_.push_back({name, gl::TextureBuffer::from(memory, "loops: index", format,
                                                          Span(values.data(), values.size()))});
    };
    add("loops_points", GL_RG32I, index.points);
    add("loops_bases", GL_RG32UI, index.bases);
    add("loops_activations", GL_RGBA32UI, index.activations);
    add("loops_styles", GL_RG32UI, index.styles);
    add("loops_nodes", GL_R32UI, index.tree.words);
    no_vertices_ = gl::VertexArray::create();
    uploaded_ = prepared_->index();
}

UpdateReport Loops::update(const View& view) {
    const LoopsIndex& index = *prepared_->index();
    if (view.antialias == Antialias::coverage && prepared_->detail().shows != LoopsDetail::Shows::layers)
        throw Error(ErrorKind::unsupported,
                    "heat maps of technique 'loops' count primitives at the centres of pixels; "
                    "draw them with antialias 'none'");
    UpdateReport report;
    report.pieces = index.tree.counts.references;
    for (const NamedBuffer& each : buffers_)
        report.bytes += each.buffer.buffer().bytes();
    report.longest_walk = index.tree.counts.longest_walk;
    report.counts = {{"loops_vertices", double(index.points.size())},
                     {"loops_primitives", double(index.items)},
                     {"loops_references", double(index.tree.counts.references)},
                     {"loops_nodes", double(index.tree.counts.nodes)},
                     {"loops_dependencies", double(index.needs)},
                     {"loops_bytes", double(report.bytes)}};
    return report;
}

void Loops::draw(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    gl::Flags flags;
    if (view.antialias == Antialias::coverage)
        flags.insert("SAMPLES");
    if (prepared_->detail().shows == LoopsDetail::Shows::tested)
        flags.insert("TESTED");
    if (prepared_->detail().shows == LoopsDetail::Shows::active)
        flags.insert("ACTIVE");
    if (!view.has_below) {
        const GLfloat nothing[] = {0.0F, 0.0F, 0.0F, 0.0F};
        glClearBufferfv(GL_COLOR, 0, nothing);
    } else {
        glEnable(GL_BLEND);
        glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    }
    draw_with(std::move(flags), view, gbuffer, programs);
    glDisable(GL_BLEND);
}

void Loops::draw_ids(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    const GLuint nothing[] = {0, 0, 0, 0};
    glClearBufferuiv(GL_COLOR, 0, nothing);
    draw_with({"IDS"}, view, gbuffer, programs);
}

void Loops::draw_with(gl::Flags flags, const View& view, const GBufferView& gbuffer,
                      gl::ProgramLibrary& programs) {
    const LoopsIndex& index = *prepared_->index();
    const LoopsDetail& detail = prepared_->detail();
    const auto is_fill = [](const loops::Style& style) { return style.half_width == 0.0F; };
    const auto add_if = [&](bool wanted, const char* flag) {
        if (wanted)
            flags.insert(flag);
    };
    add_if(std::any_of(index.styles.begin(), index.styles.end(), is_fill), "FILLS");
    add_if(!std::all_of(index.styles.begin(), index.styles.end(), is_fill), "STROKES");
    add_if(index.primitives == LinePrimitives::segments, "SEGMENTS");
    add_if(index.tree.most_lists > 1, "PATHS");
    add_if(detail.screen >= 0.0, "SCREEN");
    add_if(!detail.steps.empty(), "BY_DISTANCE");
    add_if(detail.lens >= 0.0, "CIRCLE");
    gl::Program& program = programs.get("loops", flags);
    program.use();
    program.set("position_texture", 0);
    gbuffer.position->bind(0);
    if (flags.count("SAMPLES") != 0) {
        program.set("surface_texture", 1);
        gbuffer.surface->bind(1);
    }
    int unit = 2;
    for (const NamedBuffer& each : buffers_) {
        program.set(each.name, unit);
        each.buffer.bind(static_cast<GLuint>(unit++));
    }
    const loops::Lattice& lattice = index.lattice;
    const loops::LatticeBox& box = lattice.terrain;
    program.set("root_box", glm::ivec4(box.min_x, box.min_y, box.max_x, box.max_y));
    program.set("first_block", glm::ivec2(lattice.first_block_x, lattice.first_block_y));
    program.set("block_shift",
                static_cast<int>(std::lrint(std::log2(view.positions.block_size / lattice.quantum))));
    program.set("quantum", static_cast<float>(lattice.quantum));
    program.set("length_scale", static_cast<float>(lattice.quantum / loops::length_scale));
    if (flags.count("TESTED") + flags.count("ACTIVE") != 0)
        program.set("heat_top", static_cast<float>(detail.heat_top));
    set_detail(program, view);
    no_vertices_.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void Loops::set_detail(gl::Program& program, const View& view) const {
    const LoopsDetail& detail = prepared_->detail();
    const LoopsIndex& index = *prepared_->index();
    const loops::Lattice& lattice = index.lattice;
    program.set("uniform_bound", detail.uniform >= 0.0 ? static_cast<float>(detail.uniform) : no_bound);
    if (detail.lens >= 0.0) {
        const glm::dvec2 centre((detail.lens_centre[0] - lattice.left) / lattice.quantum,
                                (detail.lens_centre[1] - lattice.bottom) / lattice.quantum);
        const glm::dvec2 nearest = glm::clamp(glm::round(centre), -1.0 * (1 << 30), 1.0 * (1 << 30));
        program.set("circle_centre", glm::ivec2(nearest));
        program.set("circle_rest", glm::vec2((centre - nearest) * lattice.quantum));
        program.set("circle",
                    glm::vec2(static_cast<float>(detail.lens_radius), static_cast<float>(detail.lens)));
    }
    if (detail.screen < 0.0 && detail.steps.empty())
        return;
    const DetailEye eye = detail.has_eye ? detail.eye : detail_eye_of(view);
    const glm::dvec2 place((eye.eye[0] - lattice.left) / lattice.quantum,
                           (eye.eye[1] - lattice.bottom) / lattice.quantum);
    const glm::dvec2 nearest = glm::clamp(glm::round(place), -1.0 * (1 << 30), 1.0 * (1 << 30));
    program.set("eye_place", glm::ivec2(nearest));
    program.set("eye_rest", glm::vec2((place - nearest) * lattice.quantum));
    const double lowest = double{index.heights.lowest}, highest = double{index.heights.highest};
    // Heights from the eye on: of the lowest ground, and up to the highest.
    program.set("eye_heights", glm::vec2(static_cast<float>(lowest - eye.eye[2]),
                                         static_cast<float>(std::max(highest - lowest, 1e-6))));
    if (detail.screen >= 0.0) {
        const bool flat = eye.pixels == 0.0;
        program.set("eye_forward", glm::vec4(eye.forward[0], eye.forward[1], eye.forward[2],
                                             std::hypot(eye.forward[0], eye.forward[1])));
        program.set("screen_bound",
                    glm::vec2(flat ? 0.0F : static_cast<float>(detail.screen * eye.corner / eye.pixels),
                              static_cast<float>(detail.screen * eye.metres_per_pixel)));
    }
    if (!detail.steps.empty()) {
        std::vector<glm::vec2> steps;
        for (size_t i = 0; i < most_detail_steps; ++i) {
            const DetailStep& step = detail.steps[std::min(i, detail.steps.size() - 1)];
            steps.emplace_back(static_cast<float>(step.distance), static_cast<float>(step.tolerance));
        }
        program.set_array("detail_steps", Span<const glm::vec2>(steps.data(), steps.size()));
    }
}

}  // namespace decalgl

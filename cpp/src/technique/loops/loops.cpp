#include "technique/loops/loops.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include "decalgl/core/error.h"
#include "gl/gl.h"
#include "gl/pass_timer.h"
#include "gl/texture.h"
#include "shared/view_block.h"

namespace decalgl {
namespace {

using loops::detail_eye_of;
using loops::LoopsIndex;

[[noreturn]] void refuse_files() {
    throw Error(ErrorKind::unsupported,
                "layers of technique 'loops' are not kept on disk; prepare the scene anew, or use technique "
                "'static'");
}

constexpr float no_bound = 3e38F;

bool same(const DetailEye& a, const DetailEye& b) {
    return a.eye == b.eye && a.forward == b.forward && a.pixels == b.pixels && a.corner == b.corner &&
           a.metres_per_pixel == b.metres_per_pixel;
}

}  // namespace

void loops::PreparedLoops::save(ArchiveWriter&, const std::string&) const {
    refuse_files();
}

std::unique_ptr<const Prepared> Loops::open(const ArchiveReader&, const std::string&,
                                            const MemoryAccount&) const {
    refuse_files();
}

std::unique_ptr<const Prepared> Loops::preprocess(const TechniqueInput& input, Progress& progress) const {
    return loops::build_loops(input, progress);
}

void Loops::upload(std::shared_ptr<const Prepared> prepared, std::shared_ptr<const Prepared> lens,
                   const TerrainView&, const MemoryAccount& memory) {
    memory_ = memory;
    prepared_ = std::static_pointer_cast<const loops::PreparedLoops>(std::move(prepared));
    if (lens && static_cast<const loops::PreparedLoops&>(*lens).slots() != prepared_->slots())
        throw Error(ErrorKind::unsupported,
                    "layers of technique 'loops' look the same inside a lens; use technique 'static' for "
                    "another look there, or Detail(lens=) for more details");
    if (uploaded_ != prepared_->index()) {
        uploaded_ = nullptr;
        key_.reset();
        buffers_.clear();
        no_vertices_ = gl::VertexArray::create();
        if (prepared_->index()->bvh)
            upload_bvh();
        uploaded_ = prepared_->index();
    } else if (uploaded_->bvh && uploaded_slots_ != prepared_->slots()) {
        buffers_.pop_back();
        add_buffer("loops_styles", GL_RG32UI, prepared_->slots()->styles);
    }
    uploaded_slots_ = prepared_->slots();
}

template <typename Values>
void Loops::add_buffer(const char* name, GLenum format, const Values& values) {
    buffers_.push_back(
        {name, gl::TextureBuffer::from(memory_, "loops: index", format, Span(values.data(), values.size()))});
}

void Loops::upload_bvh() {
    const LoopsIndex& index = *prepared_->index();
    add_buffer("loops_points", GL_RG32I, index.arcs.points);
    add_buffer("loops_bases", GL_RG32UI, index.bvh->bases);
    add_buffer("loops_activations", GL_RGBA32UI, index.activations);
    add_buffer("loops_nodes", GL_R32UI, index.bvh->tree.words);
    // The last, as it changes with the looks.
    add_buffer("loops_styles", GL_RG32UI, prepared_->slots()->styles);
}

// The cells of a view, unless they are there.
void Loops::make_cells(const View& view) {
    const gl::PassTimer timer(view.timings, "loops: cells");
    const LoopsIndex& index = *prepared_->index();
    const LoopsDetail& detail = prepared_->detail();
    CellsKey key{loops::Sight(view, index.lattice, index.heights),
                 detail.has_eye ? detail.eye : detail_eye_of(view), detail, prepared_->slots()};
    if (key_ && key_->sight == key.sight && same(key_->eye, key.eye) && key_->detail == detail &&
        key_->slots == key.slots)
        return;
    key_.reset();
    const loops::ViewDetail wanted(detail, key.eye, key.sight, index.lattice, index.heights);
    const loops::Slots& slots = *prepared_->slots();
    const loops::ActiveArcs active =
        loops::active_arcs(index.arcs, index.steps, 0, [&](uint32_t point, size_t arc) {
            return wanted.is_active(index.activations[point], double{slots.reaches[arc]});
        });
    cells_ = loops::make_cells(index.arcs, active, slots, key.sight.box(), 0);
    buffers_.clear();
    add_buffer("bucket_entries", GL_R32UI, cells_.lists.buckets);
    add_buffer("cell_entries", GL_R32UI, cells_.lists.cells);
    add_buffer("cell_texels", GL_RGBA32UI, cells_.lists.texels);
    cells_.lists.drop();
    key_ = std::move(key);
}

UpdateReport Loops::update(const View& view) {
    const LoopsIndex& index = *prepared_->index();
    if (view.antialias == Antialias::coverage && prepared_->detail().shows != LoopsDetail::Shows::layers)
        throw Error(ErrorKind::unsupported,
                    "heat maps of technique 'loops' count primitives at the centres of pixels; "
                    "draw them with antialias 'none'");
    if (!index.bvh)
        make_cells(view);
    UpdateReport report;
    for (const NamedBuffer& each : buffers_)
        report.bytes += each.buffer.buffer().bytes();
    report.pieces = index.bvh ? index.bvh->tree.counts.references : cells_.lists.edges;
    report.longest_walk = index.bvh ? index.bvh->tree.counts.longest_walk : cells_.lists.longest;
    report.counts = {{"loops_vertices", double(index.activations.size())},
                     {"loops_primitives", double(index.bvh ? index.bvh->items : cells_.active)},
                     {"loops_references", double(report.pieces)},
                     {"loops_nodes", double(index.bvh ? index.bvh->tree.counts.nodes : cells_.cells)},
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
    add_flags(flags);
    gl::Program& program = programs.get(index.bvh ? "loops" : "loops_cells", flags);
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
    program.set("first_block", glm::ivec2(lattice.first_block_x, lattice.first_block_y));
    program.set("block_shift",
                static_cast<int>(std::lrint(std::log2(view.positions.block_size / lattice.quantum))));
    program.set("quantum", static_cast<float>(lattice.quantum));
    program.set("quanta_per_metre", static_cast<float>(1.0 / lattice.quantum));
    if (flags.count("TESTED") + flags.count("ACTIVE") != 0)
        program.set("heat_top", static_cast<float>(prepared_->detail().heat_top));
    if (index.bvh)
        set_bvh(program, view);
    else
        set_cells(program);
    no_vertices_.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

// What of the programs a scene needs.
void Loops::add_flags(gl::Flags& flags) const {
    const LoopsIndex& index = *prepared_->index();
    const LoopsDetail& detail = prepared_->detail();
    const std::vector<loops::Style>& styles = prepared_->slots()->styles;
    const auto is_fill = [](const loops::Style& style) { return style.is_fill(); };
    const auto add_if = [&](bool wanted, const char* flag) {
        if (wanted)
            flags.insert(flag);
    };
    add_if(std::any_of(styles.begin(), styles.end(), is_fill), "FILLS");
    add_if(!std::all_of(styles.begin(), styles.end(), is_fill), "STROKES");
    if (!index.bvh) {
        const auto is_translucent = [](const loops::Style& style) {
            return style.is_shown() && !style.is_opaque();
        };
        add_if(std::any_of(styles.begin(), styles.end(), is_translucent), "TRANSLUCENT");
        return;
    }
    add_if(index.bvh->primitives == LinePrimitives::segments, "SEGMENTS");
    add_if(index.bvh->tree.most_lists > 1, "PATHS");
    add_if(detail.screen >= 0.0, "SCREEN");
    add_if(!detail.steps.empty(), "BY_DISTANCE");
    add_if(detail.lens >= 0.0, "CIRCLE");
}

void Loops::set_cells(gl::Program& program) const {
    program.set("grid_corner", glm::ivec2(cells_.corner.x, cells_.corner.y));
    program.set("grid_size", glm::ivec2(cells_.columns, cells_.rows));
    program.set("bucket_bits", cells_.bucket_bits);
}

void Loops::set_bvh(gl::Program& program, const View& view) const {
    const loops::Lattice& lattice = prepared_->index()->lattice;
    const loops::LatticeBox& box = lattice.terrain;
    program.set("root_box", glm::ivec4(box.min_x, box.min_y, box.max_x, box.max_y));
    program.set("length_scale", static_cast<float>(lattice.quantum / loops::length_scale));
    set_detail(program, view);
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

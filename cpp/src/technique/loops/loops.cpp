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

constexpr float no_bound = 3e38F;

bool same(const DetailEye& a, const DetailEye& b) {
    return a.eye == b.eye && a.forward == b.forward && a.pixels == b.pixels && a.corner == b.corner &&
           a.metres_per_pixel == b.metres_per_pixel;
}

}  // namespace

bool Loops::Cells::serve(const Cells& wanted, const loops::Slots& slots) const {
    return sight == wanted.sight && same(eye, wanted.eye) && detail == wanted.detail && cells.serve(slots);
}

std::unique_ptr<const Prepared> Loops::open(const ArchiveReader& archive, const std::string& prefix,
                                            const MemoryAccount&) const {
    return loops::open_loops(archive, prefix);
}

std::unique_ptr<const Prepared> Loops::preprocess(const TechniqueInput& input, Progress& progress) const {
    return loops::build_loops(input, progress);
}

void Loops::upload(std::shared_ptr<const Prepared> prepared, std::shared_ptr<const Prepared> lens,
                   const TerrainView&, const MemoryAccount& memory) {
    memory_ = memory;
    const auto index = static_cast<const loops::PreparedLoops&>(*prepared).index();
    if (uploaded_ != index) {
        uploaded_ = nullptr;
        bvh_.clear();
        outside_ = {};
        inside_ = {};
        no_vertices_ = gl::VertexArray::create();
        if (index->bvh)
            upload_bvh(*index);
        uploaded_ = index;
    }
    upload_side(std::move(prepared), outside_);
    upload_side(std::move(lens), inside_);
}

template <typename Values>
Loops::NamedBuffer Loops::buffer_of(const char* name, GLenum format, const Values& values) const {
    return {name,
            gl::TextureBuffer::from(memory_, "loops: index", format, Span(values.data(), values.size()))};
}

void Loops::upload_bvh(const LoopsIndex& index) {
    bvh_.push_back(buffer_of("loops_points", GL_RG32I, index.arcs.points));
    bvh_.push_back(buffer_of("loops_bases", GL_RG32UI, index.bvh->bases));
    bvh_.push_back(buffer_of("loops_activations", GL_RGBA32UI, index.bvh->activations));
    bvh_.push_back(buffer_of("loops_nodes", GL_R32UI, index.bvh->words));
}

void Loops::upload_side(std::shared_ptr<const Prepared> prepared, Side& side) {
    side.prepared = std::static_pointer_cast<const loops::PreparedLoops>(std::move(prepared));
    if (!side.prepared) {
        side = {};
        return;
    }
    const SharedArray<loops::Style>& styles = side.prepared->slots()->styles;
    if (side.uploaded.data() == styles.data())
        return;
    side.uploaded = {};
    side.styles = buffer_of("loops_styles", GL_RG32UI, styles);
    side.uploaded = styles;
}

// The cells of a view, unless they are there.
void Loops::make_cells(const View& view, Side& side) {
    const loops::PreparedLoops& prepared = *side.prepared;
    const LoopsDetail& detail = prepared.detail();
    Cells wanted{loops::Sight(view, uploaded_->lattice, uploaded_->heights),
                 detail.has_eye ? detail.eye : detail_eye_of(view),
                 detail,
                 {},
                 {}};
    // Heat maps are of the same cells.
    wanted.detail.shows = LoopsDetail::Shows::layers;
    wanted.detail.heat_top = LoopsDetail().heat_top;
    for (const std::shared_ptr<const Cells>& there : {side.cells, outside_.cells})
        if (there && there->serve(wanted, *prepared.slots())) {
            side.cells = there;
            return;
        }
    side.cells = nullptr;
    side.cells = cells_of(view, std::move(wanted), prepared);
}

std::shared_ptr<const Loops::Cells> Loops::cells_of(const View& view, Cells wanted,
                                                    const loops::PreparedLoops& prepared) const {
    const gl::PassTimer timer(view.timings, "loops: cells");
    const LoopsIndex& index = *prepared.index();
    const loops::Slots& slots = *prepared.slots();
    const loops::ViewDetail tolerances(wanted.detail, wanted.eye, wanted.sight, index.lattice, index.heights);
    const loops::ActiveArcs active =
        loops::active_arcs(index.arcs, index.steps, index.activations, 0,
                           [&](const loops::Activation& activation, size_t arc, bool is_inside) {
                               return tolerances.judge(activation, double{slots.reaches[arc]}, is_inside);
                           });
    loops::ViewCells& cells = wanted.cells;
    cells = loops::make_cells(index.arcs, active, slots, wanted.sight.box(), 0);
    wanted.buffers.push_back(buffer_of("bucket_entries", GL_R32UI, cells.lists.buckets));
    wanted.buffers.push_back(buffer_of("cell_entries", GL_R32UI, cells.lists.cells));
    wanted.buffers.push_back(buffer_of("cell_texels", GL_RGBA32UI, cells.lists.texels));
    cells.lists.drop();
    return std::make_shared<const Cells>(std::move(wanted));
}

void Loops::forget_view() {
    outside_.cells = inside_.cells = nullptr;
}

UpdateReport Loops::update(const View& view) {
    const LoopsIndex& index = *uploaded_;
    UpdateReport report;
    const auto add = [&](const NamedBuffer& each) { report.bytes += each.buffer.buffer().bytes(); };
    for (Side* side : {&outside_, &inside_}) {
        if (!side->prepared)
            continue;
        if (view.antialias == Antialias::coverage &&
            side->prepared->detail().shows != LoopsDetail::Shows::layers)
            throw Error(ErrorKind::unsupported,
                        "heat maps of technique 'loops' count primitives at the centres of pixels; "
                        "draw them with antialias 'none'");
        add(side->styles);
        if (index.bvh)
            continue;
        make_cells(view, *side);
        if (side == &outside_ || side->cells != outside_.cells)
            std::for_each(side->cells->buffers.begin(), side->cells->buffers.end(), add);
    }
    std::for_each(bvh_.begin(), bvh_.end(), add);
    const loops::ViewCells* cells = index.bvh ? nullptr : &outside_.cells->cells;
    report.pieces = cells ? cells->lists.edges : index.bvh->counts.references;
    report.longest_walk = cells ? cells->lists.longest : index.bvh->counts.longest_walk;
    report.counts = {{"loops_vertices", double(index.activations.size())},
                     {"loops_primitives", double(cells ? cells->active : index.bvh->items)},
                     {"loops_references", double(report.pieces)},
                     {"loops_nodes", double(cells ? cells->cells : index.bvh->counts.nodes)},
                     {"loops_dependencies", double(index.needs)},
                     {"loops_bytes", double(report.bytes)}};
    return report;
}

void Loops::draw(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    gl::Flags flags;
    if (view.antialias == Antialias::coverage)
        flags.insert("SAMPLES");
    glEnable(GL_BLEND);
    if (!view.has_below) {
        const GLfloat nothing[] = {0.0F, 0.0F, 0.0F, 0.0F};
        glClearBufferfv(GL_COLOR, 0, nothing);
        // Both sides of the lens's border make one pixel.
        if (inside_.prepared)
            glBlendFunc(GL_ONE, GL_ONE);
        else
            glDisable(GL_BLEND);
    } else {
        glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    }
    draw_sides(flags, view, gbuffer, programs);
    glDisable(GL_BLEND);
}

void Loops::draw_ids(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    const GLuint nothing[] = {0, 0, 0, 0};
    glClearBufferuiv(GL_COLOR, 0, nothing);
    draw_sides({"IDS"}, view, gbuffer, programs);
}

void Loops::draw_sides(const gl::Flags& flags, const View& view, const GBufferView& gbuffer,
                       gl::ProgramLibrary& programs) {
    draw_side(LensSide::outside, flags, view, gbuffer, programs);
    if (inside_.prepared)
        draw_side(LensSide::inside, flags, view, gbuffer, programs);
}

void Loops::draw_side(LensSide lens_side, gl::Flags flags, const View& view, const GBufferView& gbuffer,
                      gl::ProgramLibrary& programs) const {
    const Side& side = lens_side == LensSide::outside ? outside_ : inside_;
    const LoopsIndex& index = *uploaded_;
    const LoopsDetail& detail = side.prepared->detail();
    add_flags(side, flags);
    gl::Program& program = programs.get(index.bvh ? "loops" : "loops_cells", flags);
    program.use();
    program.set("position_texture", 0);
    gbuffer.position->bind(0);
    if (flags.count("SAMPLES") != 0) {
        program.set("surface_texture", 1);
        gbuffer.surface->bind(1);
    }
    if (flags.count("LENS") != 0) {
        program.set("lens_side", static_cast<int>(lens_side));
        program.set("lens_texture", 2);
        gbuffer.lens->bind(2);
    }
    int unit = 3;
    const auto bind = [&](const NamedBuffer& each) {
        program.set(each.name, unit);
        each.buffer.bind(static_cast<GLuint>(unit++));
    };
    bind(side.styles);
    const std::vector<NamedBuffer>& buffers = index.bvh ? bvh_ : side.cells->buffers;
    std::for_each(buffers.begin(), buffers.end(), bind);
    const loops::Lattice& lattice = index.lattice;
    program.set("first_block", glm::ivec2(lattice.first_block_x, lattice.first_block_y));
    program.set("block_shift",
                static_cast<int>(std::lrint(std::log2(view.positions.block_size / lattice.quantum))));
    program.set("quantum", static_cast<float>(lattice.quantum));
    program.set("quanta_per_metre", static_cast<float>(1.0 / lattice.quantum));
    if (flags.count("TESTED") + flags.count("ACTIVE") != 0)
        program.set("heat_top", static_cast<float>(detail.heat_top));
    if (index.bvh) {
        set_bvh(program, view, detail);
    } else {
        const loops::ViewCells& cells = side.cells->cells;
        program.set("grid_corner", glm::ivec2(cells.corner.x, cells.corner.y));
        program.set("grid_size", glm::ivec2(cells.columns, cells.rows));
        program.set("bucket_bits", cells.bucket_bits);
    }
    no_vertices_.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

// What of the programs a scene needs.
void Loops::add_flags(const Side& side, gl::Flags& flags) const {
    const LoopsIndex& index = *uploaded_;
    const LoopsDetail& detail = side.prepared->detail();
    const SharedArray<loops::Style>& styles = side.prepared->slots()->styles;
    const auto is_fill = [](const loops::Style& style) { return style.is_fill(); };
    const auto add_if = [&](bool wanted, const char* flag) {
        if (wanted)
            flags.insert(flag);
    };
    add_if(std::any_of(styles.begin(), styles.end(), is_fill), "FILLS");
    add_if(!std::all_of(styles.begin(), styles.end(), is_fill), "STROKES");
    add_if(inside_.prepared != nullptr, "LENS");
    if (flags.count("IDS") == 0) {
        add_if(detail.shows == LoopsDetail::Shows::tested, "TESTED");
        add_if(detail.shows == LoopsDetail::Shows::active, "ACTIVE");
    }
    if (!index.bvh) {
        const auto is_translucent = [](const loops::Style& style) {
            return style.is_shown() && !style.is_opaque();
        };
        add_if(flags.count("SAMPLES") != 0 && std::any_of(styles.begin(), styles.end(), is_translucent),
               "TRANSLUCENT");
        return;
    }
    add_if(index.bvh->primitives == LinePrimitives::segments, "SEGMENTS");
    add_if(index.bvh->most_lists > 1, "PATHS");
    add_if(detail.screen >= 0.0, "SCREEN");
    add_if(!detail.steps.empty(), "BY_DISTANCE");
    add_if(detail.lens >= 0.0, "CIRCLE");
}

void Loops::set_bvh(gl::Program& program, const View& view, const LoopsDetail& detail) const {
    const loops::Lattice& lattice = uploaded_->lattice;
    const loops::LatticeBox& box = lattice.terrain;
    program.set("root_box", glm::ivec4(box.min_x, box.min_y, box.max_x, box.max_y));
    program.set("length_scale", static_cast<float>(lattice.quantum / loops::length_scale));
    set_detail(program, view, detail);
}

void Loops::set_detail(gl::Program& program, const View& view, const LoopsDetail& detail) const {
    const LoopsIndex& index = *uploaded_;
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

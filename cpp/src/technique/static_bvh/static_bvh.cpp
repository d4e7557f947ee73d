#include "technique/static_bvh/static_bvh.h"

#include <cmath>
#include <utility>

#include "decalgl/core/error.h"
#include "gl/gl.h"
#include "gl/texture.h"

namespace decalgl {

namespace {

[[noreturn]] void refuse_files() {
    throw Error(ErrorKind::unsupported,
                "index 'bvh' is not kept on disk; prepare the scene with index 'grid'");
}

[[noreturn]] void refuse_changes() {
    throw Error(
        ErrorKind::unsupported,
        "index 'bvh' stays as it was prepared; prepare the scene with index 'grid' to restyle or edit it");
}

}  // namespace

void bvh::PreparedBvh::save(ArchiveWriter&, const std::string&) const {
    refuse_files();
}

std::shared_ptr<const Prepared> bvh::PreparedBvh::restyled(Span<const LayerLook>,
                                                           const MemoryAccount&) const {
    refuse_changes();
}

LayerLook bvh::PreparedBvh::look_of(uint32_t, size_t) const {
    refuse_changes();
}

std::shared_ptr<const Prepared> bvh::PreparedBvh::edited(const LayerEdit&, const MemoryAccount&) const {
    refuse_changes();
}

std::unique_ptr<const Prepared> StaticBvh::open(const ArchiveReader&, const std::string&,
                                                const MemoryAccount&) const {
    refuse_files();
}

std::unique_ptr<const Prepared> StaticBvh::preprocess(const TechniqueInput& input, Progress& progress) const {
    return bvh::build_bvh(input, progress);
}

void StaticBvh::upload(std::shared_ptr<const Prepared> prepared, std::shared_ptr<const Prepared>,
                       const MemoryAccount& memory) {
    prepared_ = std::static_pointer_cast<const bvh::PreparedBvh>(std::move(prepared));
    buffers_.clear();
    for (const bvh::DecalGroup& group : prepared_->groups) {
        std::vector<NamedBuffer>& buffers = buffers_.emplace_back();
        const auto add = [&](const char* name, const char* account, GLenum format, const auto& values) {
            buffers.push_back(
                {name, gl::TextureBuffer::from(memory, account, format, Span(values.data(), values.size()))});
        };
        add("bvh_cells", "static_bvh: cells", GL_RG32UI, group.cells);
        add("bvh_nodes", "static_bvh: trees", GL_RGBA32I, group.nodes);
        add("bvh_vertices", "static_bvh: vertices", GL_RG32I, group.vertices);
        add("bvh_styles", "static_bvh: styles", GL_RG32UI, group.styles);
        if (group.kind == FeatureKind::lines) {
            add("bvh_segments", "static_bvh: segments", GL_RG32UI, group.segments);
            add("bvh_owners", "static_bvh: vertices", GL_R32UI, group.owners);
        } else {
            add("bvh_exteriors", "static_bvh: polygons", GL_RGBA32UI, group.exteriors);
            add("bvh_interiors", "static_bvh: polygons", GL_R32UI, group.interiors);
            add("bvh_quads", "static_bvh: quad-trees", GL_RGBA32I, group.quads.boxes);
            add("bvh_quad_links", "static_bvh: quad-trees", GL_RG32UI, group.quads.links);
            add("bvh_leaf_edges", "static_bvh: quad-trees", GL_RGBA32I, group.quads.edges);
        }
    }
    no_vertices_ = gl::VertexArray::create();
}

UpdateReport StaticBvh::update(const View&) {
    UpdateReport report;
    report.pieces = prepared_->pieces;
    for (const std::vector<NamedBuffer>& group : buffers_)
        for (const NamedBuffer& each : group)
            report.bytes += each.buffer.buffer().bytes();
    report.longest_walk = prepared_->longest_walk;
    return report;
}

void StaticBvh::draw(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    const GLfloat nothing[] = {0.0F, 0.0F, 0.0F, 0.0F};
    glClearBufferfv(GL_COLOR, 0, nothing);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    for (size_t group = 0; group < buffers_.size(); ++group) {
        gl::Flags flags;
        if (view.antialias == Antialias::coverage)
            flags.insert("COVERAGE");
        draw_group(group, std::move(flags), view, gbuffer, programs);
    }
    glDisable(GL_BLEND);
}

void StaticBvh::draw_ids(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    const GLuint nothing[] = {0, 0, 0, 0};
    glClearBufferuiv(GL_COLOR, 0, nothing);
    for (size_t group = 0; group < buffers_.size(); ++group)
        draw_group(group, {"IDS"}, view, gbuffer, programs);
}

void StaticBvh::draw_group(size_t index, gl::Flags flags, const View& view, const GBufferView& gbuffer,
                           gl::ProgramLibrary& programs) {
    const bvh::DecalGroup& group = prepared_->groups[index];
    const bvh::Lattice& lattice = prepared_->lattice;
    if (group.kind == FeatureKind::polygons)
        flags.insert("RINGS");
    else if (prepared_->options.composition == Composition::nearest)
        flags.insert("NEAREST");
    else if (prepared_->options.segment_order == SegmentOrder::hilbert)
        flags.insert("UNSORTED");
    gl::Program& program = programs.get("static_bvh", flags);
    program.use();
    program.set("position_texture", 0);
    gbuffer.position->bind(0);
    if (flags.count("COVERAGE") != 0) {
        program.set("surface_texture", 1);
        gbuffer.surface->bind(1);
    }
    int unit = 2;
    for (const NamedBuffer& each : buffers_[index]) {
        program.set(each.name, unit);
        each.buffer.bind(static_cast<GLuint>(unit++));
    }
    const bvh::LatticeBox& box = group.grid.box;
    program.set("grid_box", glm::ivec4(box.min_x, box.min_y, box.max_x, box.max_y));
    program.set("grid_size", glm::ivec2(group.grid.columns, group.grid.rows));
    program.set("cell_size", glm::ivec2(group.grid.cell_width, group.grid.cell_height));
    program.set("first_block", glm::ivec2(lattice.first_block_x, lattice.first_block_y));
    program.set("block_shift",
                static_cast<int>(std::lrint(std::log2(view.positions.block_size / lattice.quantum))));
    program.set("quanta_per_metre", static_cast<float>(1.0 / lattice.quantum));
    if (flags.count("IDS") != 0)
        program.set("first_slot", group.first_slot);
    no_vertices_.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace decalgl

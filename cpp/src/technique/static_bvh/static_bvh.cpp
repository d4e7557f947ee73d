#include "technique/static_bvh/static_bvh.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>

#include "decalgl/core/error.h"
#include "gl/gl.h"

namespace decalgl {

namespace {

using bvh::GroupKind;

// Less than the depth of any pixel with a border (static_bvh.frag.glsl), and more than that of those without.
constexpr double between_depth = 0.005;
// Mesa's software rasteriser ends the loops of one shader run after 65,535 turns in all.
constexpr uint64_t most_turns = 65535;
// Samples are drawn in strips of the picture, so that all that is kept of a strip is no more than this many pixels.
constexpr int pixels_at_once = 1 << 20;

// Whether lines are drawn by how much of a pixel they cover, and not by samples.
bool by_coverage(const View& view, const bvh::DecalGroup& group) {
    return view.antialias == Antialias::coverage && view.coverage == CoverageRule::thoeny &&
           group.kind == GroupKind::strokes;
}

// The share of a pixel that is inside the lens, or whether its centre is.
void set_lens(Antialias antialias, const GBufferView& gbuffer, int unit, gl::Program& program) {
    program.set("lens_texture", unit);
    gbuffer.lens->bind(static_cast<GLuint>(unit));
    program.set("by_share", antialias == Antialias::coverage);
}

// For a word that is not 0 where the search of some pixel did not come to its end.
gl::Buffer begin_searches(const MemoryAccount& memory) {
    gl::Buffer unfinished = gl::Buffer::create(memory, "static_bvh: searches", sizeof(uint32_t));
    unfinished.clear();
    unfinished.bind_base(GL_SHADER_STORAGE_BUFFER, 0);
    return unfinished;
}

void require_finished(const gl::Buffer& unfinished) {
    if (unfinished.read<uint32_t>().front() != 0)
        throw Error(
            ErrorKind::unsupported,
            "a pixel of this view has more segments than coverage='thoeny' can look at, as this driver "
            "ends loops after " +
                std::to_string(most_turns) +
                " turns; come closer, or draw with coverage='exact' or index='grid'");
}

[[noreturn]] void refuse_files() {
    throw Error(ErrorKind::unsupported,
                "index 'bvh' is not kept on disk; prepare the scene with index 'grid'");
}

}  // namespace

void bvh::PreparedBvh::save(ArchiveWriter&, const std::string&) const {
    refuse_files();
}

std::unique_ptr<const Prepared> StaticBvh::open(const ArchiveReader&, const std::string&,
                                                const MemoryAccount&) const {
    refuse_files();
}

std::unique_ptr<const Prepared> StaticBvh::preprocess(const TechniqueInput& input, Progress& progress) const {
    return bvh::build_bvh(input, progress);
}

void StaticBvh::upload(std::shared_ptr<const Prepared> prepared, std::shared_ptr<const Prepared> lens,
                       const TerrainView&, const MemoryAccount& memory) {
    memory_ = memory;
    upload(std::static_pointer_cast<const bvh::PreparedBvh>(std::move(prepared)), outside_, nullptr);
    if (lens)
        upload(std::static_pointer_cast<const bvh::PreparedBvh>(std::move(lens)), inside_, &outside_);
    else
        inside_ = {};
    no_vertices_ = gl::VertexArray::create();
}

// What the other look holds already is shared with it.
void StaticBvh::upload(std::shared_ptr<const bvh::PreparedBvh> prepared, Look& look,
                       const Look* other) const {
    look.buffers.resize(prepared->groups.size());
    for (size_t i = 0; i < look.buffers.size(); ++i) {
        const bvh::DecalGroup& group = prepared->groups[i];
        const std::vector<NamedBuffer> before = std::exchange(look.buffers[i], {});
        const std::vector<NamedBuffer> none;
        const std::vector<NamedBuffer>& others = other != nullptr ? other->buffers[i] : none;
        const auto add = [&](const char* name, const char* account, GLenum format, const auto& array) {
            std::shared_ptr<gl::GrowingBuffer> buffer;
            for (const NamedBuffer& each : before)
                if (std::string_view(each.name) == name &&
                    (each.buffer.use_count() == 1 || each.buffer->holds(array)))
                    buffer = each.buffer;
            for (const NamedBuffer& each : others)
                if (std::string_view(each.name) == name && each.buffer->holds(array))
                    buffer = each.buffer;
            if (!buffer)
                buffer = std::make_shared<gl::GrowingBuffer>();
            buffer->upload(array, format, account, memory_);
            look.buffers[i].push_back({name, std::move(buffer)});
        };
        add("bvh_cells", "static_bvh: cells", GL_RGBA32UI, group.cells);
        add("bvh_nodes", "static_bvh: trees", GL_RGBA32I, group.nodes);
        add("bvh_styles", "static_bvh: styles", GL_RGBA32UI, group.styles);
        if (group.needs.corners || group.needs.hatches)
            add("bvh_looks", "static_bvh: styles", GL_RGBA32UI, group.looks);
        if (group.kind != GroupKind::fills) {
            add("bvh_vertices", "static_bvh: vertices", GL_RG32I, group.vertices);
            add("bvh_segments", "static_bvh: segments", GL_RG32UI, group.segments);
            static constexpr GLenum formats[] = {GL_R32UI, GL_RG32UI, GL_RGB32UI};
            add("bvh_owners", "static_bvh: vertices", formats[group.owner_size() - 1], group.owners);
        }
        if (group.kind != GroupKind::strokes) {
            add("bvh_ring_vertices", "static_bvh: vertices", GL_RG32I, group.ring_vertices);
            add("bvh_exteriors", "static_bvh: polygons", GL_RGBA32UI, group.exteriors);
            add("bvh_interiors", "static_bvh: polygons", GL_R32UI, group.interiors);
            add("bvh_quads", "static_bvh: quad-trees", GL_RGBA32I, group.quads.boxes);
            add("bvh_quad_links", "static_bvh: quad-trees", GL_RG32UI, group.quads.links);
            add("bvh_leaf_edges", "static_bvh: quad-trees", GL_RGBA32I, group.quads.edges);
        }
        if (group.kind == GroupKind::both)
            add("bvh_objects", "static_bvh: objects", GL_RG32UI, group.objects);
    }
    look.prepared = std::move(prepared);
}

UpdateReport StaticBvh::update(const View&) {
    UpdateReport report;
    report.pieces = outside_.prepared->pieces;
    std::set<const gl::GrowingBuffer*> counted;
    for (const Look* look : {&outside_, &inside_})
        for (const std::vector<NamedBuffer>& group : look->buffers)
            for (const NamedBuffer& each : group)
                if (counted.insert(each.buffer.get()).second)
                    report.bytes += each.buffer->bytes();
    report.longest_walk = outside_.prepared->longest_walk;
    return report;
}

void StaticBvh::draw(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    const GLfloat nothing[] = {0.0F, 0.0F, 0.0F, 0.0F};
    if (!view.has_below)
        glClearBufferfv(GL_COLOR, 0, nothing);
    const auto& groups = outside_.prepared->groups;
    const bool searches = std::any_of(groups.begin(), groups.end(),
                                      [&](const bvh::DecalGroup& group) { return by_coverage(view, group); });
    const gl::Buffer unfinished = searches ? begin_searches(memory_) : gl::Buffer();
    glEnable(GL_BLEND);
    if (inside_.prepared && gbuffer.lens != nullptr)
        draw_through_lens(view, gbuffer, programs);
    else
        draw_look(view, gbuffer, programs);
    glDisable(GL_BLEND);
    if (searches)
        require_finished(unfinished);
}

void StaticBvh::draw_look(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    const auto& groups = drawn_->prepared->groups;
    const bool in_samples = std::any_of(groups.begin(), groups.end(), [&](const bvh::DecalGroup& group) {
        return !by_coverage(view, group);
    });
    if (view.antialias == Antialias::coverage && in_samples)
        draw_samples(view, gbuffer, programs);
    else
        draw_groups(0, groups.size(), {}, {}, view, gbuffer, programs);
}

// What is inside is drawn over a copy of what lies below, of which each pixel then takes its share.
void StaticBvh::draw_through_lens(const View& view, const GBufferView& gbuffer,
                                  gl::ProgramLibrary& programs) {
    GLint target = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &target);
    const int width = gbuffer.position->width(), height = gbuffer.position->height();
    const Canvas inside = canvas(GL_RGBA8, width, height);
    glBlitNamedFramebuffer(static_cast<GLuint>(target), inside.target.id(), 0, 0, width, height, 0, 0, width,
                           height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    draw_look(view, gbuffer, programs);
    inside.target.bind();
    drawn_ = &inside_;
    draw_look(view, gbuffer, programs);
    drawn_ = &outside_;
    glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(target));
    glViewport(0, 0, width, height);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC1_ALPHA);
    gl::Program& program = programs.get("static_bvh_lens");
    program.use();
    program.set("inside", 0);
    inside.picture.bind(0);
    set_lens(view.antialias, gbuffer, 1, program);
    no_vertices_.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    // Framebuffers of several attachments take no second source, even where they do not blend.
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
}

void StaticBvh::draw_ids(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    const GLuint nothing[] = {0, 0, 0, 0};
    glClearBufferuiv(GL_COLOR, 0, nothing);
    View centres = view;
    centres.antialias = Antialias::none;
    draw_groups(0, drawn_->prepared->groups.size(), {"IDS"}, {}, centres, gbuffer, programs);
    if (!inside_.prepared || gbuffer.lens == nullptr)
        return;
    drawn_ = &inside_;
    draw_groups(0, drawn_->prepared->groups.size(), {"IDS"}, {}, centres, gbuffer, programs);
    drawn_ = &outside_;
}

// Neighbouring groups that are drawn in the same way: by coverage, or in samples.
struct StaticBvh::Run {
    size_t begin, end;
    bool by_coverage;
    Canvas canvas;  // by coverage: their picture, which all samples share
};

StaticBvh::Canvas StaticBvh::canvas(GLenum format, int width, int height, const gl::Texture2D* depth) const {
    Canvas made;
    made.picture = gl::Texture2D::create(memory_, "static_bvh: samples", format, width, height);
    std::vector<gl::Attachment> attachments{{GL_COLOR_ATTACHMENT0, &made.picture}};
    if (depth != nullptr)
        attachments.push_back({GL_DEPTH_ATTACHMENT, depth});
    made.target = gl::Framebuffer::create("samples", attachments);
    return made;
}

std::vector<StaticBvh::Run> StaticBvh::runs_of(const View& view) const {
    std::vector<Run> runs;
    for (size_t i = 0; i < drawn_->prepared->groups.size(); ++i) {
        const bool coverage = by_coverage(view, drawn_->prepared->groups[i]);
        if (runs.empty() || runs.back().by_coverage != coverage)
            runs.push_back({i, i, coverage, {}});
        runs.back().end = i + 1;
    }
    return runs;
}

void StaticBvh::lay(const Canvas& from, int first_row, float share, gl::ProgramLibrary& programs) const {
    gl::Program& program = programs.get("static_bvh_mean");
    program.use();
    program.set("samples", 0);
    from.picture.bind(0);
    program.set("first_row", first_row);
    program.set("share", share);
    no_vertices_.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

// The nearest border of all groups in each pixel, by the depth test, and how near it is, in the depth.
void StaticBvh::find_borders(const Canvas& borders, const std::vector<Run>& runs, int row, const View& view,
                             const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    glDisable(GL_BLEND);
    glDepthMask(GL_TRUE);
    glDepthRange(0.0, 1.0);
    glDepthFunc(GL_GREATER);
    borders.target.clear_color(0, 0.0F, 0.0F, 0.0F, 0.0F);
    borders.target.clear_depth(0.0F);
    borders.target.bind();
    for (const Run& run : runs)
        if (!run.by_coverage)
            draw_groups(run.begin, run.end, {"BORDERS"}, {row}, view, gbuffer, programs);
    glDepthMask(GL_FALSE);
    glDepthRange(between_depth, between_depth);
    glEnable(GL_BLEND);
}

void StaticBvh::draw_runs(const std::vector<Run>& runs, const gl::Flags& flags, Strip strip, const View& view,
                          const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    for (const Run& run : runs) {
        if (run.by_coverage)
            lay(run.canvas, 0, 1.0F, programs);
        else
            draw_groups(run.begin, run.end, flags, strip, view, gbuffer, programs);
    }
}

// All groups for one sample of each pixel, over each other; then the next. So the mean is that of the composite, also
// where edges of several groups meet. A single group takes all its samples at once, unless its walks are very long.
void StaticBvh::add_samples(const Canvas& sum, const Canvas& sample, const std::vector<Run>& runs,
                            Strip strip, const View& view, const GBufferView& gbuffer,
                            gl::ProgramLibrary& programs) {
    if (drawn_->buffers.size() == 1 && drawn_->prepared->longest_walk * BORDER_SAMPLES < most_turns) {
        strip.end_sample = BORDER_SAMPLES;
        draw_runs(runs, {"SAMPLES"}, strip, view, gbuffer, programs);
        return;
    }
    for (int i = 0; i < BORDER_SAMPLES; ++i) {
        strip.first_sample = i;
        strip.end_sample = i + 1;
        sample.target.clear_color(0, 0.0F, 0.0F, 0.0F, 0.0F);
        sample.target.bind();
        draw_runs(runs, {"SAMPLES"}, strip, view, gbuffer, programs);
        sum.target.bind();
        glBlendFunc(GL_ONE, GL_ONE);
        lay(sample, 0, 1.0F / BORDER_SAMPLES, programs);
    }
}

// Pixels without a border are what their centre is, and the others the mean of their samples.
void StaticBvh::draw_samples(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    GLint target = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &target);
    const int width = gbuffer.position->width(), height = gbuffer.position->height();
    std::vector<Run> runs = runs_of(view);
    const auto kept = std::count_if(runs.begin(), runs.end(), [](const Run& run) { return run.by_coverage; });
    const int rows = std::clamp(pixels_at_once / width / static_cast<int>(3 + kept), 1, height);
    const gl::Texture2D depth =
        gl::Texture2D::create(memory_, "static_bvh: samples", GL_DEPTH_COMPONENT32F, width, rows);
    const Canvas borders = canvas(GL_RG32F, width, rows, &depth);
    const Canvas sample = canvas(GL_RGBA32F, width, rows, &depth);
    const Canvas sum = canvas(GL_RGBA32F, width, rows, &depth);
    for (Run& run : runs)
        if (run.by_coverage)
            run.canvas = canvas(GL_RGBA32F, width, rows);
    const auto begin = [](const Canvas& canvas) {
        canvas.target.clear_color(0, 0.0F, 0.0F, 0.0F, 0.0F);
        canvas.target.bind();
    };
    for (int row = 0; row < height; row += rows) {
        glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
        for (const Run& run : runs) {
            if (!run.by_coverage)
                continue;
            begin(run.canvas);
            draw_groups(run.begin, run.end, {}, {row}, view, gbuffer, programs);
        }
        glEnable(GL_DEPTH_TEST);
        find_borders(borders, runs, row, view, gbuffer, programs);
        begin(sum);
        glDepthFunc(GL_GREATER);
        draw_runs(runs, {}, {row}, view, gbuffer, programs);
        glDepthFunc(GL_LESS);
        add_samples(sum, sample, runs, {row, &borders.picture}, view, gbuffer, programs);
        glDisable(GL_DEPTH_TEST);
        glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(target));
        glViewport(0, row, width, std::min(rows, height - row));
        glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
        lay(sum, row, 1.0F, programs);
    }
    glDepthMask(GL_TRUE);
    glDepthRange(0.0, 1.0);
    glDepthFunc(GL_GREATER);
    glViewport(0, 0, width, height);
}

void StaticBvh::draw_groups(size_t begin, size_t end, const gl::Flags& flags, Strip strip, const View& view,
                            const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    for (size_t group = begin; group < end; ++group)
        if (drawn_->prepared->groups[group].has_shown)
            draw_group(group, flags, strip, view, gbuffer, programs);
}

SlopeUse StaticBvh::slope_use() const {
    for (const Look* look : {&outside_, &inside_}) {
        if (!look->prepared)
            continue;
        for (const bvh::DecalGroup& group : look->prepared->groups) {
            if (group.needs.slopes)
                return SlopeUse::widths;
        }
    }
    return SlopeUse::none;
}

gl::Flags StaticBvh::flags_of(const bvh::DecalGroup& group) const {
    gl::Flags flags;
    const auto add_if = [&](bool wanted, const char* flag) {
        if (wanted)
            flags.insert(flag);
    };
    const bool is_line = group.kind == GroupKind::strokes;
    const bool hilbert = drawn_->prepared->options.segment_order == SegmentOrder::hilbert;
    const bool nearest = is_line && drawn_->prepared->options.composition == Composition::nearest;
    add_if(group.kind == GroupKind::fills, "RINGS");
    add_if(group.kind == GroupKind::both, "BOTH");
    add_if(group.cut == OutlineMode::inset, "INSET");
    add_if(group.cut == OutlineMode::offset, "OFFSET");
    add_if(group.needs.corners, "CORNERS");
    add_if(group.needs.patterns, "PATTERNS");
    add_if(group.needs.ground, "GROUND");
    add_if(group.needs.bands, "BANDS");
    add_if(group.needs.slopes, "SLOPES");
    add_if(group.needs.hatches, "HATCHES");
    add_if(group.has_hidden, "HIDDEN");
    add_if(nearest, "NEAREST");
    add_if(is_line && !nearest && hilbert, "UNSORTED");
    return flags;
}

void StaticBvh::draw_group(size_t index, gl::Flags flags, Strip strip, const View& view,
                           const GBufferView& gbuffer, gl::ProgramLibrary& programs) {
    const bvh::DecalGroup& group = drawn_->prepared->groups[index];
    const bvh::Lattice& lattice = drawn_->prepared->lattice;
    flags.merge(flags_of(group));
    if (flags.count("IDS") == 0 && by_coverage(view, group)) {
        flags.erase("UNSORTED");
        flags.insert("THOENY");
    }
    if (flags.count("BORDERS") != 0 && group.grid.cell_count() > FAR_CELLS)
        flags.insert("FAR");
    const bool has_lens = inside_.prepared && gbuffer.lens != nullptr;
    if (has_lens)
        flags.insert("LENS");
    gl::Program& program = programs.get("static_bvh", flags);
    program.use();
    program.set("position_texture", 0);
    gbuffer.position->bind(0);
    if (flags.count("SAMPLES") + flags.count("BORDERS") + flags.count("THOENY") + flags.count("SLOPES") !=
        0) {
        program.set("surface_texture", 1);
        gbuffer.surface->bind(1);
    }
    program.set("first_row", strip.first_row);
    int unit = 2;
    if (flags.count("SAMPLES") != 0) {
        program.set("sample_range", glm::ivec2(strip.first_sample, strip.end_sample));
        program.set("border_texture", unit);
        strip.borders->bind(static_cast<GLuint>(unit++));
    }
    if (has_lens) {
        set_lens(view.antialias, gbuffer, unit++, program);
        program.set("inside", drawn_ == &inside_);
    }
    for (const NamedBuffer& each : drawn_->buffers[index]) {
        program.set(each.name, unit);
        each.buffer->bind(static_cast<GLuint>(unit++));
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

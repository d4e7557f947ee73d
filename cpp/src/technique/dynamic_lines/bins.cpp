#include "technique/dynamic_lines/bins.h"

#include <algorithm>
#include <array>
#include <string>

#include "decalgl/core/error.h"
#include "gl/context.h"
#include "gl/gl.h"
#include "gl/pass_timer.h"
#include "technique/dynamic_lines/bins_layout.h"
#include "technique/dynamic_lines/dispatch.h"
#include "technique/half_planes.h"

namespace decalgl {
namespace {

// Runs: enough for all cores, as long as the counts of all tiles stay few, which are summed up for every view. The cores of a
// CPU are few.
constexpr uint32_t shortest_run = 512;
constexpr uint32_t least_runs = 8;
constexpr uint32_t most_runs = 2048;
constexpr uint32_t most_counts = 1U << 23;
constexpr uint32_t most_counts_on_cpu = 1U << 19;

// Mesa's software rasteriser ends the loops of one shader run after 65,535 turns in all, up to 16 invocations together. A row of
// tiles is never left half done.
constexpr int most_turns = 65535 / 16 - 4096 / TILE_SIDE;

// Blocks that bin_tiles.comp.glsl writes the list through.
constexpr uint64_t most_windows = 4;

uint32_t divided(uint32_t count, uint32_t by) {
    return (count + by - 1) / by;
}

gl::TextureBuffer make_texels(const MemoryAccount& memory, GLenum format, size_t texel_bytes, size_t count) {
    return gl::TextureBuffer::create(memory, "dynamic: bins", format,
                                     texel_bytes * std::max<size_t>(count, 1));
}

}  // namespace

LineBins::LineBins(const MemoryAccount& memory) : memory_(memory), no_vertices_(gl::VertexArray::create()) {}

void LineBins::reserve(const View& view, uint32_t segments, bool with_arcs) {
    grid_ = {static_cast<int>(divided(static_cast<uint32_t>(view.width), TILE_SIDE)),
             static_cast<int>(divided(static_cast<uint32_t>(view.height), TILE_SIDE))};
    const auto tiles = static_cast<uint32_t>(grid_.x * grid_.y);
    const bool software = gl::Context::require_current().info().software;
    const uint32_t counts_room = software ? most_counts_on_cpu : most_counts;
    run_count_ =
        std::clamp(segments / shortest_run, 1U, std::clamp(counts_room / tiles, least_runs, most_runs));
    run_length_ = std::max(divided(segments, run_count_), 1U);
    if (segments > segment_room_ || !ends_ || with_arcs != static_cast<bool>(arcs_)) {
        segment_room_ = 0;
        for (gl::TextureBuffer* buffer : {&ends_, &joints_, &spans_, &reaches_, &arcs_})
            *buffer = gl::TextureBuffer();
        ends_ = make_texels(memory_, GL_RGBA32F, 16, segments);
        joints_ = make_texels(memory_, GL_RGBA32UI, 16, segments);
        spans_ = make_texels(memory_, GL_RGBA32F, 16, segments);
        reaches_ = make_texels(memory_, GL_R32F, 4, segments);
        if (with_arcs)
            arcs_ = make_texels(memory_, GL_RG32UI, 8, segments);
        segment_room_ = segments;
    }
    if (run_count_ > progress_.bytes() / sizeof(glm::uvec2)) {
        progress_ = gl::Buffer();
        progress_ = gl::Buffer::create(memory_, "dynamic: bins", sizeof(glm::uvec2) * run_count_);
    }
    if (!unfinished_)
        unfinished_ = gl::Buffer::create(memory_, "dynamic: bins", sizeof(uint32_t));
    const uint32_t counts = tiles * run_count_ + 1;
    if (counts > places_.texels()) {
        places_ = gl::TextureBuffer();
        places_ = make_texels(memory_, GL_R32UI, 4, counts);
        sums_ = PrefixSum();
        sums_ = PrefixSum(counts, memory_);
    }
}

void LineBins::update(const View& view, const MatchedLines& lines, const SegmentList& segments,
                      const LineLooks& looks, gl::ProgramLibrary& programs) {
    reserve(view, segments.most, looks.summary().is_styled);
    ground_ = lines.ground;
    if (view.antialias == Antialias::coverage && !half_planes_)
        half_planes_ =
            gl::TextureBuffer::from(memory_, "dynamic: half planes", GL_RG32UI, make_half_planes());
    {
        const gl::PassTimer timer(view.timings, "dynamic: project");
        project(view, lines, segments, looks, programs);
    }
    const gl::PassTimer timer(view.timings, "dynamic: bins");
    sort(segments, programs);
}

void LineBins::project(const View& view, const MatchedLines& lines, const SegmentList& segments,
                       const LineLooks& looks, gl::ProgramLibrary& programs) {
    gl::Program& program = programs.get("dynamic_bin_project", looks.flags());
    program.set("line_vertices", 0);
    lines.vertices.bind(0);
    program.set("line_records", 1);
    lines.lines.bind(1);
    program.set("line_segments", 2);
    segments.segments.bind(2);
    looks.bind(program, 3);
    LatticeBase(lines.lattice, view).set(program);
    set_ground_slack(program, view);
    if (arcs_) {
        program.set("line_arcs", 4);
        lines.arcs.bind(4);
    }
    segments.count.bind_base(GL_SHADER_STORAGE_BUFFER, 0);
    dispatch(program, segments.most, [&](uint32_t first, uint32_t count) {
        bind_records(1, ends_.buffer(), 16, first, count);
        bind_records(2, joints_.buffer(), 16, first, count);
        bind_records(3, spans_.buffer(), 16, first, count);
        bind_records(4, reaches_.buffer(), 4, first, count);
        if (arcs_)
            bind_records(5, arcs_.buffer(), 8, first, count);
    });
}

void LineBins::run_tiles(const SegmentList& segments, const gl::Flags& flags, gl::ProgramLibrary& programs) {
    gl::Program& program = programs.get("dynamic_bin_tiles", flags);
    program.set("segment_spans", 0);
    spans_.bind(0);
    program.set("segment_reaches", 1);
    reaches_.bind(1);
    program.set("tile_grid", grid_);
    program.set("run_count", run_count_);
    program.set("run_length", run_length_);
    segments.count.bind_base(GL_SHADER_STORAGE_BUFFER, 0);
    places_.buffer().bind_base(GL_SHADER_STORAGE_BUFFER, 1);
    progress_.bind_base(GL_SHADER_STORAGE_BUFFER, 3);
    unfinished_.bind_base(GL_SHADER_STORAGE_BUFFER, 4);
    program.set("most_turns", most_turns);
    if (flags.count("WINDOWS") > 0)
        program.set("window",
                    static_cast<uint32_t>(gl::Context::require_current().info().max_storage_block_bytes /
                                          static_cast<long long>(sizeof(uint32_t))));
    progress_.clear();
    uint32_t is_unfinished = 0;
    do {
        unfinished_.clear();
        dispatch(program, run_count_);
        unfinished_.read(0, sizeof(is_unfinished), &is_unfinished);
    } while (is_unfinished != 0);
}

// The list, in as many windows as the driver's blocks ask for.
gl::Flags LineBins::bind_list() {
    const auto window = static_cast<uint64_t>(gl::Context::require_current().info().max_storage_block_bytes);
    const uint64_t bytes = list_.buffer().bytes();
    constexpr std::array<GLuint, most_windows> bindings{2, 5, 6, 7};
    for (size_t i = 0; i < bindings.size() && i * window < bytes; ++i)
        glBindBufferRange(GL_SHADER_STORAGE_BUFFER, bindings[i], list_.buffer().id(),
                          static_cast<GLintptr>(i * window),
                          static_cast<GLsizeiptr>(std::min(window, bytes - i * window)));
    return bytes > window ? gl::Flags{"FILL", "WINDOWS"} : gl::Flags{"FILL"};
}

// The list is as long as the counts say, and never shorter.
void LineBins::sort(const SegmentList& segments, gl::ProgramLibrary& programs) {
    const auto counts = static_cast<uint32_t>(grid_.x * grid_.y) * run_count_;
    places_.buffer().clear();
    run_tiles(segments, {}, programs);
    sums_.run(places_.buffer(), counts + 1, programs);
    places_.buffer().read(sizeof(uint32_t) * counts, sizeof(uint32_t), &entry_count_);
    const gl::ContextInfo& info = gl::Context::require_current().info();
    const auto limit =
        std::min(most_windows * static_cast<uint64_t>(info.max_storage_block_bytes) / sizeof(uint32_t),
                 static_cast<uint64_t>(info.max_texture_buffer_size));
    if (entry_count_ > limit)
        throw Error(ErrorKind::memory,
                    "dynamic lines: in this view they fall into " + std::to_string(entry_count_) +
                        " tiles, more than this driver's buffers hold; give them a smaller width, or a "
                        "picture of fewer pixels");
    if (entry_count_ > list_.texels()) {
        list_ = gl::TextureBuffer();
        list_ = make_texels(memory_, GL_R32UI, 4,
                            std::min<uint64_t>(uint64_t{entry_count_} + entry_count_ / 2, limit));
    }
    if (entry_count_ > 0)
        run_tiles(segments, bind_list(), programs);
}

uint64_t LineBins::bytes() const {
    uint64_t bytes = sums_.bytes() + half_planes_.buffer().bytes() + progress_.bytes() + unfinished_.bytes();
    for (const gl::TextureBuffer* buffer : {&ends_, &joints_, &spans_, &reaches_, &arcs_, &places_, &list_})
        bytes += buffer->buffer().bytes();
    return bytes;
}

}  // namespace decalgl

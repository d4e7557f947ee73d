#include "technique/dynamic_lines/update_segments.h"

#include <algorithm>
#include <string>

#include "decalgl/core/error.h"
#include "gl/context.h"
#include "gl/pass_timer.h"
#include "shared/view_block.h"
#include "technique/dynamic_lines/dispatch.h"

namespace decalgl {
namespace {

constexpr uint32_t word_bits = 32;

uint32_t words_of(uint32_t items) {
    return (items + word_bits - 1) / word_bits;
}

// Half as much again as is needed, so that a moving camera seldom needs more; never above `most`.
uint32_t with_room(uint32_t needed, uint32_t most) {
    return static_cast<uint32_t>(std::clamp<uint64_t>(needed + uint64_t{needed} / 2, 1, std::max(most, 1U)));
}

void require_block(uint64_t bytes, const char* what) {
    const auto limit = static_cast<uint64_t>(gl::Context::require_current().info().max_storage_block_bytes);
    if (bytes > limit)
        throw Error(ErrorKind::memory,
                    std::string("dynamic lines: the ") + what + " that this view shows need " +
                        format_bytes(bytes) + ", more than the " + format_bytes(limit) +
                        " that this driver binds at once; draw fewer lines, or look closer");
}

void bind_vertices(gl::Program& program, const MatchedLines& lines) {
    program.set("line_vertices", 0);
    lines.vertices.bind(0);
}

}  // namespace

SegmentUpdate::SegmentUpdate(const MatchedLines& lines, double cell, glm::vec2 ground_heights,
                             const MemoryAccount& memory)
    : lines_(&lines),
      cells_per_pixel_(cell > 0.0 ? static_cast<float>(1.0 / cell) : 0.0F),
      ground_heights_(ground_heights),
      memory_(memory),
      sum_(words_of(lines.vertex_count) + 1, memory) {
    vertices_.make_room(lines.vertex_count, memory);
}

void SegmentUpdate::Selection::make_room(uint32_t items, const MemoryAccount& memory) {
    const uint32_t needed = words_of(items);
    if (offsets && needed <= words)
        return;
    masks = gl::Buffer();
    offsets = gl::Buffer();
    words = needed;
    masks = gl::Buffer::create(memory, "dynamic: update", sizeof(uint32_t) * words);
    offsets = gl::Buffer::create(memory, "dynamic: update", sizeof(uint32_t) * (size_t{words} + 1));
}

// Counts of bits become the places that they begin at; the number of all.
uint32_t SegmentUpdate::add_up(const Selection& selection, uint32_t words, gl::ProgramLibrary& programs) {
    sum_.run(selection.offsets, words + 1, programs);
    uint32_t total = 0;
    selection.offsets.read(sizeof(uint32_t) * words, sizeof(uint32_t), &total);
    return total;
}

const SegmentList& SegmentUpdate::run(const View& view, LineReach reach, gl::ProgramLibrary& programs) {
    base_ = LatticeBase(lines_->lattice, view);
    keep_vertices(view, programs);
    keep_segments(view, reach, programs);
    return list_;
}

void SegmentUpdate::keep_vertices(const View& view, gl::ProgramLibrary& programs) {
    const uint32_t words = words_of(lines_->vertex_count);
    {
        const gl::PassTimer timer(view.timings, "dynamic: simplify");
        vertices_.offsets.clear();
        gl::Program& program = programs.get("dynamic_update_vertices");
        bind_vertices(program, *lines_);
        base_.set(program);
        program.set("vertex_count", lines_->vertex_count);
        program.set("cells_per_pixel", cells_per_pixel_);
        vertices_.masks.bind_base(GL_SHADER_STORAGE_BUFFER, 0);
        vertices_.offsets.bind_base(GL_SHADER_STORAGE_BUFFER, 1);
        dispatch(program, words);
    }
    const gl::PassTimer timer(view.timings, "dynamic: compact vertices");
    kept_count_ = add_up(vertices_, words, programs);
    if (!kept_ || kept_count_ > kept_room_) {
        require_block(sizeof(uint32_t) * uint64_t{kept_count_}, "vertices");
        kept_ = gl::Buffer();
        kept_room_ = with_room(kept_count_, lines_->vertex_count);
        kept_ = gl::Buffer::create(memory_, "dynamic: update", sizeof(uint32_t) * size_t{kept_room_});
    }
    gl::Program& program = programs.get("dynamic_update_kept");
    vertices_.masks.bind_base(GL_SHADER_STORAGE_BUFFER, 0);
    vertices_.offsets.bind_base(GL_SHADER_STORAGE_BUFFER, 1);
    kept_.bind_base(GL_SHADER_STORAGE_BUFFER, 2);
    dispatch(program, words);
}

void SegmentUpdate::keep_segments(const View& view, LineReach reach, gl::ProgramLibrary& programs) {
    const uint32_t words = words_of(kept_count_);
    {
        const gl::PassTimer timer(view.timings, "dynamic: cull");
        segments_.make_room(kept_room_, memory_);
        segments_.offsets.clear();
        gl::Program& program = programs.get("dynamic_update_cull");
        bind_vertices(program, *lines_);
        base_.set(program);
        const vec4 base = view.block->base_sample_fraction;
        program.set("ground_heights", (ground_heights_ - base.z) - base.w);
        program.set("reach_px", reach.px + 1.0F);  // samples lie off the pixels' centres
        program.set("reach_metres", reach.metres);
        program.set("kept_count", kept_count_);
        segments_.masks.bind_base(GL_SHADER_STORAGE_BUFFER, 0);
        segments_.offsets.bind_base(GL_SHADER_STORAGE_BUFFER, 1);
        kept_.bind_base(GL_SHADER_STORAGE_BUFFER, 2);
        dispatch(program, words);
    }
    const gl::PassTimer timer(view.timings, "dynamic: compact segments");
    const uint32_t count = add_up(segments_, words, programs);
    if (!list_.count || count > segment_room_) {
        require_block(sizeof(LineSegment) * uint64_t{count}, "segments");
        list_ = SegmentList();
        segment_room_ = with_room(count, lines_->segment_count);
        list_.segments = gl::TextureBuffer::create(memory_, "dynamic: segments", GL_RGBA32UI,
                                                   sizeof(LineSegment) * size_t{segment_room_});
        list_.count = gl::Buffer::create(memory_, "dynamic: segments", 4 * sizeof(uint32_t), nullptr,
                                         GL_DYNAMIC_STORAGE_BIT);
    }
    list_.most = count;
    list_.count.update(std::vector<uint32_t>{count, 1, 0, 0});
    gl::Program& program = programs.get("dynamic_update_segments");
    bind_vertices(program, *lines_);
    program.set("line_records", 1);
    lines_->lines.bind(1);
    const gl::Buffer* buffers[] = {&vertices_.masks, &vertices_.offsets, &kept_,
                                   &segments_.masks, &segments_.offsets, &list_.segments.buffer()};
    for (GLuint i = 0; i < 6; ++i)
        buffers[i]->bind_base(GL_SHADER_STORAGE_BUFFER, i);
    dispatch(program, words);
}

void SegmentUpdate::report(UpdateReport& report) const {
    report.counts.emplace_back("dynamic_vertices", lines_->vertex_count);
    report.counts.emplace_back("dynamic_kept_vertices", kept_count_);
    report.counts.emplace_back("dynamic_segments", list_.most);
    for (const gl::Buffer* buffer : {&vertices_.masks, &vertices_.offsets, &segments_.masks,
                                     &segments_.offsets, &kept_, &list_.segments.buffer(), &list_.count})
        report.bytes += buffer->bytes();
    report.bytes += sum_.bytes();
}

}  // namespace decalgl

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
// Segments, so that parts of their buffer begin where every driver lets them.
constexpr uint32_t place_alignment = 256 / sizeof(LineSegment);

uint32_t words_of(uint32_t items) {
    return (items + word_bits - 1) / word_bits;
}

// Half as much again as is needed, so that a moving camera seldom needs more; never above `most`.
uint32_t with_room(uint32_t needed, uint32_t most) {
    return static_cast<uint32_t>(std::clamp<uint64_t>(needed + uint64_t{needed} / 2, 1, std::max(most, 1U)));
}

uint64_t most_storage_bytes() {
    return static_cast<uint64_t>(gl::Context::require_current().info().max_storage_block_bytes);
}

void require_block_of_vertices(uint64_t bytes) {
    if (bytes > most_storage_bytes())
        throw Error(ErrorKind::memory,
                    "dynamic lines: the vertices that this view shows need " + format_bytes(bytes) +
                        ", more than the " + format_bytes(most_storage_bytes()) +
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
        require_block_of_vertices(sizeof(uint32_t) * uint64_t{kept_count_});
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
    const gl::Buffer* buffers[] = {&vertices_.masks, &vertices_.offsets, &kept_, &segments_.masks,
                                   &segments_.offsets};
    for (GLuint i = 0; i < 5; ++i)
        buffers[i]->bind_base(GL_SHADER_STORAGE_BUFFER, i);
    write_segments(program, words);
}

// As many words of the mask at a time as name segments for one block of the driver's.
void SegmentUpdate::write_segments(gl::Program& program, uint32_t words) {
    const auto block = static_cast<uint32_t>(most_storage_bytes() / sizeof(LineSegment));
    const uint32_t most_words = (block - place_alignment) / word_bits;
    for (uint32_t first = 0; first < words; first += most_words) {
        uint32_t place = 0;
        if (first > 0)
            segments_.offsets.read(sizeof(uint32_t) * first, sizeof(uint32_t), &place);
        if (place == list_.most)
            return;
        place -= place % place_alignment;
        program.set("first_word", first);
        program.set("first_place", place);
        bind_records(5, list_.segments.buffer(), sizeof(LineSegment), place,
                     std::min(block, segment_room_ - place));
        dispatch(program, std::min(words - first, most_words));
    }
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

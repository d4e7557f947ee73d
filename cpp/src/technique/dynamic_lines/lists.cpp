#include "technique/dynamic_lines/lists.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "decalgl/core/error.h"
#include "gl/context.h"
#include "gl/gl.h"
#include "gl/pass_timer.h"
#include "gl/texture.h"
#include "shared/view_block.h"
#include "technique/dynamic_lines/dispatch.h"

namespace decalgl {
namespace {

// Mesa's software rasteriser ends the loops of one shader run after 65,535 turns in all.
constexpr uint32_t most_turns = 60000;
constexpr uint32_t longest_list = most_turns;

constexpr size_t entry_bytes = 2 * sizeof(uint32_t);

struct Totals {
    uint32_t entries = 0;
    uint32_t is_too_long = 0;
    uint32_t is_unsorted = 0;
};

uint32_t pixels_of(const GBufferView& gbuffer) {
    return static_cast<uint32_t>(gbuffer.surface->width()) * static_cast<uint32_t>(gbuffer.surface->height());
}

gl::Flags with_sides(const ListedLines& listed, gl::Flags flags) {
    if (listed.looks->summary().has_sides)
        flags.insert("SIDES");
    return flags;
}

[[noreturn]] void refuse(const std::string& what) {
    throw Error(ErrorKind::memory, "dynamic lines, method 'lists': " + what +
                                       "; use method 'bins', narrower lines or a smaller picture");
}

void fill_words(const gl::Buffer& buffer, uint32_t value) {
    glClearNamedBufferData(buffer.id(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &value);
}

// Draws the far sides of boxes into no texture at all, whatever the depth: so a box around the eye counts as well.
class BoxState {
public:
    explicit BoxState(const View& view) {
        const ViewBlock& block = *view.block;
        glViewport(-block.picture.x, -block.picture.y, view.width, view.height);
        glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
        glEnable(GL_DEPTH_CLAMP);
        glEnable(GL_CULL_FACE);
        glCullFace(GL_FRONT);
    }
    ~BoxState() {
        glDisable(GL_CULL_FACE);
        glDisable(GL_DEPTH_CLAMP);
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        glViewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
    }
    BoxState(const BoxState&) = delete;
    BoxState& operator=(const BoxState&) = delete;

private:
    static std::array<GLint, 4> current_viewport() {
        std::array<GLint, 4> viewport{};
        glGetIntegerv(GL_VIEWPORT, viewport.data());
        return viewport;
    }

    std::array<GLint, 4> viewport_ = current_viewport();
};

}  // namespace

LineLists::LineLists(const MemoryAccount& memory, uint32_t first_room)
    : memory_(memory), no_vertices_(gl::VertexArray::create()), first_room_(first_room) {}

void LineLists::make_room_for_pixels(const GBufferView& gbuffer) {
    const uint32_t pixels = pixels_of(gbuffer);
    if (totals_ && pixels <= pixel_room_)
        return;
    heads_ = gl::TextureBuffer();
    for (gl::Buffer* buffer : {&counts_, &sorted_, &totals_})
        *buffer = gl::Buffer();
    pixel_room_ = pixels;
    const size_t bytes = sizeof(uint32_t) * size_t{pixels};
    heads_ = gl::TextureBuffer::create(memory_, "dynamic: lists", GL_R32UI, bytes);
    for (gl::Buffer* buffer : {&counts_, &sorted_})
        *buffer = gl::Buffer::create(memory_, "dynamic: lists", bytes);
    totals_ = gl::Buffer::create(memory_, "dynamic: lists", sizeof(Totals), nullptr, GL_DYNAMIC_STORAGE_BIT);
}

// For those of the latest try and half as many more.
void LineLists::make_room_for_entries(bool has_sides) {
    const auto limit = static_cast<uint64_t>(gl::Context::require_current().info().max_storage_block_bytes);
    const uint64_t most = limit / entry_bytes;
    if (entry_count_ > most)
        refuse("this view needs " + std::to_string(entry_count_) + " entries, more than the " +
               std::to_string(most) + " that this driver binds at once");
    const uint64_t wanted = std::max<uint64_t>(first_room_, entry_count_ + uint64_t{entry_count_} / 2);
    for (gl::TextureBuffer* buffer : {&next_, &entries_, &asides_})
        *buffer = gl::TextureBuffer();
    entry_room_ = static_cast<uint32_t>(std::min(std::max<uint64_t>(wanted, 1), most));
    next_ = gl::TextureBuffer::create(memory_, "dynamic: lists", GL_R32UI,
                                      sizeof(uint32_t) * size_t{entry_room_});
    entries_ = gl::TextureBuffer::create(memory_, "dynamic: lists", GL_RG32UI, entry_bytes * entry_room_);
    if (has_sides)
        asides_ = gl::TextureBuffer::create(memory_, "dynamic: lists", GL_R32UI,
                                            sizeof(uint32_t) * size_t{entry_room_});
}

void LineLists::bind_lists() const {
    const gl::Buffer* buffers[] = {&heads_.buffer(),   &counts_, &next_.buffer(),
                                   &entries_.buffer(), &totals_, &sorted_};
    for (GLuint i = 0; i < 6; ++i)
        buffers[i]->bind_base(GL_SHADER_STORAGE_BUFFER, i);
    if (asides_)
        asides_.buffer().bind_base(GL_SHADER_STORAGE_BUFFER, 6);
}

void LineLists::fill_once(const View& view, const GBufferView& gbuffer, const ListedLines& listed,
                          gl::ProgramLibrary& programs) {
    fill_words(heads_.buffer(), 0xFFFFFFFFU);
    fill_words(counts_, 0);
    const Totals none;
    totals_.update(0, sizeof(none), &none);
    bind_lists();
    gl::Flags flags = with_sides(listed, listed.looks->flags());
    if (listed.width_rule == LineWidthRule::thesis)
        flags.insert("THESIS");
    gl::Program& program = programs.get("dynamic_list_boxes", flags);
    program.use();
    program.set("line_vertices", 0);
    listed.lines->vertices.bind(0);
    program.set("line_records", 1);
    listed.lines->lines.bind(1);
    program.set("line_segments", 2);
    listed.segments->segments.bind(2);
    listed.looks->bind(program, 3);
    program.set("surface_texture", 4);
    gbuffer.surface->bind(4);
    if (listed.looks->has_lens()) {
        program.set("lens_texture", 5);
        gbuffer.lens->bind(5);
    }
    if (listed.looks->summary().is_styled) {
        program.set("line_arcs", 6);
        listed.lines->arcs.bind(6);
    }
    bind_ground(program, *listed.lines->ground, view);
    LatticeBase(listed.lines->lattice, view).set(program);
    const vec4 base = view.block->base_sample_fraction;
    program.set("ground_heights", (listed.ground_heights - base.z) - base.w);
    program.set("picture_width", gbuffer.surface->width());
    program.set("entry_room", entry_room_);
    program.set("longest_list", longest_list);
    const BoxState state(view);
    no_vertices_.bind();
    glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(listed.segments->most));
    finish_writes();
}

// Until all entries fit: none is ever left out.
void LineLists::fill(const View& view, const GBufferView& gbuffer, const ListedLines& listed,
                     gl::ProgramLibrary& programs) {
    const gl::PassTimer timer(view.timings, "dynamic: lists");
    make_room_for_pixels(gbuffer);
    entry_count_ = 0;
    const bool has_sides = listed.looks->summary().has_sides;
    if (!entries_ || (has_sides && !asides_))
        make_room_for_entries(has_sides);
    Totals totals;
    do {
        if (entry_count_ > entry_room_)
            make_room_for_entries(has_sides);
        fill_once(view, gbuffer, listed, programs);
        totals_.read(0, sizeof(totals), &totals);
        entry_count_ = totals.entries;
    } while (entry_count_ > entry_room_);
    if (totals.is_too_long != 0)
        refuse("more than " + std::to_string(longest_list) + " segments lie at one pixel of this view");
}

void LineLists::sort(const View& view, const GBufferView& gbuffer, const gl::Flags& flags,
                     gl::ProgramLibrary& programs) {
    const gl::PassTimer timer(view.timings, "dynamic: sort");
    fill_words(sorted_, 0);
    bind_lists();
    gl::Program& program = programs.get("dynamic_list_sort", flags);
    program.set("most_turns", most_turns);
    Totals totals;
    do {
        totals.is_unsorted = 0;
        totals_.update(0, sizeof(totals), &totals);
        dispatch(program, pixels_of(gbuffer));
        totals_.read(0, sizeof(totals), &totals);
    } while (totals.is_unsorted != 0);
}

void LineLists::show(const GBufferView& gbuffer, const gl::Flags& flags, gl::ProgramLibrary& programs) const {
    gl::Program& program = programs.get("dynamic_lists", flags);
    program.use();
    const std::pair<const char*, const gl::TextureBuffer*> buffers[] = {
        {"list_heads", &heads_}, {"list_next", &next_}, {"list_entries", &entries_}};
    int unit = 0;
    for (const auto& [name, buffer] : buffers) {
        program.set(name, unit);
        buffer->bind(static_cast<GLuint>(unit++));
    }
    if (flags.count("SIDES") != 0) {
        program.set("list_asides", unit);
        asides_.bind(static_cast<GLuint>(unit));
    }
    program.set("picture_width", gbuffer.surface->width());
    no_vertices_.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void LineLists::draw(const View& view, const GBufferView& gbuffer, const ListedLines& listed,
                     gl::ProgramLibrary& programs) {
    if (view.has_below) {
        glEnable(GL_BLEND);
        glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    }
    const float nothing[4] = {0.0F, 0.0F, 0.0F, 0.0F};
    if (!view.has_below && listed.segments->most == 0)
        glClearBufferfv(GL_COLOR, 0, nothing);
    if (listed.segments->most > 0) {
        const LineSummary& summary = listed.looks->summary();
        const bool is_union = summary.has_one_look && !summary.has_translucency;
        fill(view, gbuffer, listed, programs);
        if (!is_union)
            sort(view, gbuffer, with_sides(listed, {}), programs);
        const gl::PassTimer timer(view.timings, "dynamic: show");
        show(gbuffer, is_union ? gl::Flags{"UNION"} : with_sides(listed, {}), programs);
    }
    glDisable(GL_BLEND);
}

void LineLists::draw_ids(const View& view, const GBufferView& gbuffer, const ListedLines& listed,
                         gl::ProgramLibrary& programs) {
    const GLuint nothing[4] = {0, 0, 0, 0};
    glClearBufferuiv(GL_COLOR, 0, nothing);
    if (listed.segments->most == 0)
        return;
    fill(view, gbuffer, listed, programs);
    show(gbuffer, with_sides(listed, {"IDS"}), programs);
}

uint64_t LineLists::bytes() const {
    uint64_t bytes = 0;
    for (const gl::Buffer* buffer : {&heads_.buffer(), &counts_, &sorted_, &next_.buffer(),
                                     &entries_.buffer(), &asides_.buffer(), &totals_})
        bytes += buffer->bytes();
    return bytes;
}

}  // namespace decalgl

// method="lists": the lines of each pixel in a list of its own, filled by boxes around the segments and then sorted
// (Zechmeister 2020, sections 3.3.2, 3.3.3 and 3.4.2; shaders/technique/dynamic_lines/lists_buffers.glsl).
//
//     segments ─▶ boxes ─▶ fragments ─▶ lists ─▶ sorted lists ─▶ picture
//                  ▲                     │
//                  └── more room ◀───────┘ where entries did not fit
#pragma once

#include <glm/vec2.hpp>

#include "decalgl/technique/dynamic_options.h"
#include "gl/vertex_array.h"
#include "technique/dynamic_lines/line_looks.h"
#include "technique/dynamic_lines/line_set.h"

namespace decalgl {

// What lists are made of.
struct ListedLines {
    const MatchedLines* lines;
    const SegmentList* segments;
    const LineLooks* looks;
    LineWidthRule width_rule = LineWidthRule::screen;
    glm::vec2 ground_heights{0.0F};  // the lowest and the highest of the terrain
};

class LineLists {
public:
    // `first_room`: entries that there is room for to begin with.
    explicit LineLists(const MemoryAccount& memory, uint32_t first_room = 1U << 16);

    // Throws Error(memory) where the lists of a picture do not fit.
    void draw(const View& view, const GBufferView& gbuffer, const ListedLines& listed,
              gl::ProgramLibrary& programs);
    void draw_ids(const View& view, const GBufferView& gbuffer, const ListedLines& listed,
                  gl::ProgramLibrary& programs);

    uint64_t bytes() const;
    uint32_t entries() const { return entry_count_; }  // of the latest picture

private:
    void fill(const View& view, const GBufferView& gbuffer, const ListedLines& listed,
              gl::ProgramLibrary& programs);
    void fill_once(const View& view, const GBufferView& gbuffer, const ListedLines& listed,
                   gl::ProgramLibrary& programs);
    void sort(const View& view, const GBufferView& gbuffer, const gl::Flags& flags,
              gl::ProgramLibrary& programs);
    void show(const GBufferView& gbuffer, const gl::Flags& flags, gl::ProgramLibrary& programs) const;
    void make_room_for_pixels(const GBufferView& gbuffer);
    void make_room_for_entries(bool has_sides);
    void bind_lists() const;

    MemoryAccount memory_;
    gl::VertexArray no_vertices_;
    gl::TextureBuffer heads_;  // of each pixel
    gl::Buffer counts_, sorted_;
    gl::TextureBuffer next_, entries_;
    gl::TextureBuffer asides_;  // of each entry, where there are inset or offset outlines
    gl::Buffer totals_;
    uint32_t pixel_room_ = 0;
    uint32_t entry_room_ = 0;
    uint32_t first_room_;
    uint32_t entry_count_ = 0;
};

}  // namespace decalgl

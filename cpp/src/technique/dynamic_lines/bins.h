// method="bins": the segments of a view, sorted into tiles of the screen (shaders/technique/dynamic_lines/bins_layout.h).
#pragma once

#include "gl/vertex_array.h"
#include "technique/dynamic_lines/line_looks.h"
#include "technique/dynamic_lines/line_set.h"
#include "technique/dynamic_lines/prefix_sum.h"

namespace decalgl {

class LineBins {
public:
    explicit LineBins(const MemoryAccount& memory);

    // Sorts what a view leaves of the lines. Throws Error(memory).
    void update(const View& view, const MatchedLines& lines, const SegmentList& segments,
                const LineLooks& looks, gl::ProgramLibrary& programs);
    // In place of `update`, for a view of other places.
    void see_nothing() { entry_count_ = 0; }
    void draw(const View& view, const GBufferView& gbuffer, const LineLooks& looks,
              gl::ProgramLibrary& programs) const;
    void draw_ids(const View& view, const GBufferView& gbuffer, const LineLooks& looks,
                  gl::ProgramLibrary& programs) const;

    uint64_t bytes() const;
    uint32_t entries() const { return entry_count_; }  // of all tiles together

private:
    void reserve(const View& view, uint32_t segments, bool with_arcs);
    void project(const View& view, const MatchedLines& lines, const SegmentList& segments,
                 const LineLooks& looks, gl::ProgramLibrary& programs);
    void sort(const SegmentList& segments, gl::ProgramLibrary& programs);
    void run_tiles(const SegmentList& segments, const gl::Flags& flags, gl::ProgramLibrary& programs);
    gl::Flags bind_list();
    void draw_tiles(gl::Flags flags, const View& view, const GBufferView& gbuffer, const LineLooks& looks,
                    gl::ProgramLibrary& programs) const;
    void bind(gl::Program& program, const View& view, const GBufferView& gbuffer,
              const LineLooks& looks) const;

    MemoryAccount memory_;
    gl::VertexArray no_vertices_;
    glm::ivec2 grid_{0};  // of tiles
    uint32_t run_count_ = 0;
    uint32_t run_length_ = 0;
    uint32_t entry_count_ = 0;
    uint32_t segment_room_ = 0;
    gl::TextureBuffer ends_, joints_, spans_, reaches_;
    gl::TextureBuffer arcs_;                 // where some line has a pattern or bands
    const gl::Texture2D* ground_ = nullptr;  // of the lines of the latest update
    gl::TextureBuffer places_;               // of each tile and run
    gl::TextureBuffer list_;
    gl::Buffer progress_, unfinished_;  // of the runs
    gl::TextureBuffer half_planes_;
    PrefixSum sums_;
};

}  // namespace decalgl

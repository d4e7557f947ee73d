// What a view shows of the lines: the update of indices (Zechmeister 2020, sections 3.3.1 and 4.3.1).
//
//     matched vertices ──▶ a bit each: kept ──▶ their sum ──▶ kept vertices      pixel simplification
//     kept vertices ─────▶ a bit each: seen ──▶ their sum ──▶ segments           culling
//
// The stream compaction that the thesis could not run is a prefix sum over words of 32 bits. It keeps the order, so
// segments stand in draw order, and a line's neighbours next to each other.
#pragma once

#include <glm/vec2.hpp>

#include "technique/dynamic_lines/line_looks.h"
#include "technique/dynamic_lines/line_set.h"
#include "technique/dynamic_lines/prefix_sum.h"

namespace decalgl {

class SegmentUpdate {
public:
    // `lines` outlive this object. `cell`: in pixels, of the simplification; 0: all vertices are kept.
    // `ground_heights`: the lowest and the highest of the terrain.
    SegmentUpdate(const MatchedLines& lines, double cell, glm::vec2 ground_heights,
                  const MemoryAccount& memory);

    // Throws Error(memory).
    const SegmentList& run(const View& view, LineReach reach, gl::ProgramLibrary& programs);

    // In place of `run`, for a view of other places.
    void see_nothing() { list_.most = kept_count_ = 0; }

    // What the latest view left.
    const SegmentList& segments() const { return list_; }
    // Vertices before and after the simplification, segments after culling, and bytes of GL memory.
    void report(UpdateReport& report) const;

    uint32_t kept_vertices() const { return kept_count_; }

private:
    // Bits of items, and how many are set before each word of them.
    struct Selection {
        gl::Buffer masks;
        gl::Buffer offsets;
        uint32_t words = 0;  // that there is room for

        void make_room(uint32_t items, const MemoryAccount& memory);
    };

    void keep_vertices(const View& view, gl::ProgramLibrary& programs);
    void keep_segments(const View& view, LineReach reach, gl::ProgramLibrary& programs);
    void write_segments(gl::Program& program, uint32_t words);
    uint32_t add_up(const Selection& selection, uint32_t words, gl::ProgramLibrary& programs);

    const MatchedLines* lines_;
    float cells_per_pixel_;
    glm::vec2 ground_heights_;
    MemoryAccount memory_;
    LatticeBase base_;
    PrefixSum sum_;
    Selection vertices_;
    Selection segments_;
    gl::Buffer kept_;
    uint32_t kept_count_ = 0;
    uint32_t kept_room_ = 0;
    uint32_t segment_room_ = 0;
    SegmentList list_;
};

}  // namespace decalgl

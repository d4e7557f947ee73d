// Lines on the GPU: matched once to the ground, and the segments that a view leaves of them.
#pragma once

#include "decalgl/technique/technique.h"
#include "gl/buffer.h"
#include "technique/dynamic_lines/line_buffers.h"

namespace decalgl {

// The lattice that places lie on (line_buffers.h).
struct LineLattice {
    double origin_x = 0.0;
    double origin_y = 0.0;
    double quantum = 1.0;

    // Around a terrain.
    static LineLattice over(const Bounds& bounds);
    ivec2 place(double x, double y) const;
};

// Where the view's base lies on the lattice: uniforms `base_place`, `base_rest` and `quantum`.
struct LatticeBase {
    ivec2 place{0};
    glm::vec2 rest{0.0F};
    float quantum = 1.0F;

    LatticeBase() = default;
    LatticeBase(const LineLattice& lattice, const View& view);
};

// What upload leaves, and no view changes.
struct MatchedLines {
    LineLattice lattice;
    gl::Buffer vertices;  // MatchedVertex
    gl::Buffer lines;     // LineRecord, counted in matched vertices
    gl::Buffer arcs;      // float a matched vertex; only where there are patterns
    uint32_t vertex_count = 0;
    uint32_t line_count = 0;
    uint32_t segment_count = 0;  // of all lines together
};

// What a view leaves to be drawn. `count` holds four words for indirect calls: (segments, 1, 0, 0).
struct SegmentList {
    gl::Buffer segments;  // LineSegment
    gl::Buffer count;
    uint32_t most = 0;  // segments that there is room for
};

}  // namespace decalgl

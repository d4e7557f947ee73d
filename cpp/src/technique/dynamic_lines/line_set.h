// Lines on the GPU: matched once to the ground, and the segments that a view leaves of them.
#pragma once

#include "decalgl/technique/technique.h"
#include "gl/buffer.h"
#include "gl/program.h"
#include "technique/dynamic_lines/line_buffers.h"
#include "technique/dynamic_lines/line_lattice.h"
#include "technique/dynamic_lines/prepared_lines.h"

namespace decalgl {

// The ground that lines are looked for on (ground_height.glsl): a texture and how far it may be seen off.
void bind_ground(gl::Program& program, const gl::Texture2D& heights, const View& view);
void set_ground_slack(gl::Program& program, const View& view);

// Where the view's base lies on the lattice: uniforms `base_place`, `base_rest` and `quantum`.
struct LatticeBase {
    ivec2 place{0};
    glm::vec2 rest{0.0F};
    float quantum = 1.0F;

    LatticeBase() = default;
    LatticeBase(const LineLattice& lattice, const View& view);
    void set(gl::Program& program) const;
};

// What upload leaves, and no view changes.
struct MatchedLines {
    LineLattice lattice;
    gl::TextureBuffer vertices;             // MatchedVertex, RGBA32UI
    gl::TextureBuffer lines;                // LineRecord, counted in matched vertices, RGBA32UI
    gl::TextureBuffer arcs;                 // of each vertex, R32UI; none where no style asks for them
    const gl::Texture2D* ground = nullptr;  // samples of the terrain
    uint32_t vertex_count = 0;
    uint32_t line_count = 0;
    uint32_t segment_count = 0;  // of all lines together
};

// Subdivides the lines and puts them on the ground (Zechmeister 2020, sections 3.2.2 and 4.2.2). Throws Error(memory).
MatchedLines match_lines(const PreparedLines& prepared, const TerrainView& terrain,
                         const MemoryAccount& memory, gl::ProgramLibrary& programs);

// What a view leaves to be drawn. `count` holds four words for indirect calls: (segments, 1, 0, 0).
struct SegmentList {
    gl::TextureBuffer segments;  // LineSegment, RGBA32UI
    gl::Buffer count;
    uint32_t most = 0;  // segments: no more than these
};

}  // namespace decalgl

// The buffers of dynamic lines. Read by C++ and GLSL alike (std430).
//
//     source vertices ──match──▶ matched vertices ──update(view)──▶ segments ──▶ bins or lists ──▶ pixels
//     as they came               on the ground, pieces              (previous, from, to, next)
//     lines (first, count) ────▶ lines (first, count)
//
// A line is a part of a feature as one decal draws it: with a casing it is there twice. Lines stand in draw order from
// bottom to top, and so do their vertices and segments: of two segments the one with the higher index lies on top.
// The vertices of a line follow each other; the last one of a closed line repeats its first.
//
// Places are integers on a lattice around the terrain, in quanta of a power of two metres, less than 2^30 either way.
// A place relative to the view's base, in metres:
//
//     vec2(place - base_place) * quantum - base_rest
//
// Lengths along a line are counted around: what is whole of the length that 2^32 stand for is a whole number of the
// pattern's periods in every octave (line_styles.h), so nothing is lost on long lines. Those of matched vertices stand in a
// buffer of their own, where there is a pattern at all.
//
// A segment names matched vertices. `previous` is NO_VERTEX where an open line begins, `next` where it ends. In a
// closed line, the segment before the first is the last, and its previous vertex is the one before the last. After
// simplification, all four are vertices that are left.
#ifndef DECALGL_LINE_BUFFERS_H
#define DECALGL_LINE_BUFFERS_H

#ifdef __cplusplus
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
namespace decalgl {
using glm::ivec2;
using glm::uvec4;
using uint = uint32_t;
#endif

#define NO_VERTEX 0xFFFFFFFFu
#define LINE_CLOSED 1u
#define LINE_INSIDE_RIGHT 2u  // of a ring: its polygon lies to the right

struct SourceVertex {
    ivec2 place;
    uint
        arc;  // of a line with a pattern, metres on the map from its first vertex, in 2^-32 of a length of its own
    uint line;
};

struct MatchedVertex {
    ivec2 place;
    float height;  // of the ground, metres; never missing
    uint line;
};

struct LineRecord {
    uint first;  // vertex
    uint count;  // of vertices, at least 2: a point is a segment of length 0
    uint slot;   // of the decal: its place from bottom to top
    uint flags;
};

// previous, from, to, next.
#define LineSegment uvec4

#ifdef __cplusplus
static_assert(sizeof(SourceVertex) == 16 && sizeof(MatchedVertex) == 16 && sizeof(LineRecord) == 16,
              "std430");
}  // namespace decalgl
#endif

#endif

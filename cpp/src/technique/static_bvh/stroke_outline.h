// What a segment of a stroke may cover: an outline for the cells, a box for their trees.
//
// Zechmeister 2020, section 4.2.1: segments are extended to rectangles, or to quadrilaterals where they are
// mitred. A corner belongs to both its segments, so each outline takes in its half of the corner, which lies
// on the outer side of the turn:
//
//     round          miter           bevel           butt, square
//     +-------+      +---------+     +------+        +-----+ - +
//     |---.   |      |       .       |     .         |     |   |
//     |---'   |      |     .         |    .          |     |   |
//     +-------+      +-----+         +---+           +-----+ - +
#pragma once

#include "decalgl/vector/stroke.h"
#include "technique/static_bvh/decal_grid.h"

namespace decalgl::bvh {

struct StrokeOutline {
    Quadrilateral corners;
    LatticeBox box;
};

// One end of a segment: its vertex, and the one after it, which is the same where the stroke ends.
struct SegmentEnd {
    LatticePoint vertex;
    LatticePoint next;
    bool plain;  // neither corner nor cap
};

// Of a stroke that is round everywhere.
StrokeOutline round_outline(LatticePoint a, LatticePoint b, double half_width);

StrokeOutline styled_outline(const SegmentEnd& a, const SegmentEnd& b, const StrokeStyle& style,
                             double half_width);

}  // namespace decalgl::bvh

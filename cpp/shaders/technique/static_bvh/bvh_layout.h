// The buffers of the BVH index, after figure 4.2 of Zechmeister 2020. Read by C++ and GLSL alike.
//
//     cells         first node, object, count, 0     of each cell
//     nodes         box                              cell by cell: a complete binary tree, root first
//
//     segments      vertex, vertex                   strokes: the objects of the cells
//     vertices      x, y                             of strokes, in quanta of the lattice
//     owners        slot (, phase (, slant))         the stroke of each vertex; where its pattern has come to; of lengths along
//                                                    it on the edge that ends there
//
//     exteriors     subtree, slot, first, count      fills: the objects of the cells
//     interiors     subtree                          of the other rings, cell by cell
//     ring_vertices x, y
//     quads         box                              nodes of all quad-trees; children are four in a row
//     quad_links    kind | count << 2, first         first child, or the leaf's segments
//     leaf_edges    vertex, vertex, first row, end   the ring's own edges, and closing ones
//
//     objects       place, exterior                  groups with both: what the objects are (STROKE_OBJECT)
//     styles        colour, half width, look, rank   of each slot; its place in draw order, the topmost 0
//     looks         see below                        what slots share
//
// A box is min x, min y, max x, max y and holds its border. Lattice points are the only places there are: a
// pixel's position is rounded to the nearest, so boxes side by side share no point and leave none out.
//
// Where strokes are more than round, their vertices come in chains with a guard at either end, so that the
// vertices before and after a segment are next to its own: those of a closed line once more from its other
// end, and the end itself of an open one, which makes a cap there.
//
//     open     0 0 1 2 2         closed   2 0 1 2 0 1
//
// A look of a stroke is a header, its pattern's marks and its bands, a texel each:
//
//     kinds and counts, cosine of the miter limit, period, 0
//     begin, end, begin width, end width
//     reach, colour, 0, 0
//
// A look of a fill is a header with the number of sets of hatch lines, and two texels for each set: what a
// quantum to the right and one upwards add to the phase, 64 bits each (high word first), and then the phase at
// the lattice's origin and the phase up to which the hatch is on, 32 bits each. A whole turn is a spacing.
#ifndef DECALGL_BVH_LAYOUT_H
#define DECALGL_BVH_LAYOUT_H

// Kinds of quad-tree nodes, as numbered in section 4.2.1.
#define QUAD_INTERNAL 0u
#define QUAD_OUTSIDE 1u
#define QUAD_INSIDE 2u
#define QUAD_PARTIAL 3u
#define QUAD_KIND_MASK 3u
#define QUAD_COUNT_SHIFT 2

// An exterior whose first ring does not reach into the cell.
#define NO_SUBTREE 0xFFFFFFFFu
// The first vertex of an edge that closes a leaf along its left border.
#define CLOSING_EDGE 0xFFFFFFFFu
// The slot of an exterior without a fill; the exterior of a stroke whose feature holds nothing of the cell.
#define NO_SLOT 0xFFFFFFFFu
#define NO_EXTERIOR 0xFFFFFFFFu

// An object that is a segment, in a group with fills.
#define STROKE_OBJECT 0x80000000u
// A vertex of a segment where the stroke goes on without a corner or a cap.
#define PLAIN_END 0x80000000u

// The first word of a stroke's look.
#define LOOK_CORNER_SHIFT 0
#define LOOK_CAP_SHIFT 2
#define LOOK_SLOPE_SHIFT 4
#define LOOK_KIND_MASK 3u
#define LOOK_MARKS_SHIFT 8
#define LOOK_BANDS_SHIFT 16
#define LOOK_COUNT_MASK 255u

// In a pixel that a border passes through (sample_place.glsl).
#define BORDER_SAMPLES 64
// Pixels of more cells are not searched all over for borders (find_borders.glsl).
#define FAR_CELLS 2048

#endif

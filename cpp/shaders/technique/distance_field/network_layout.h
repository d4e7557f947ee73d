// The buffers of a network and of its styles, for C++ and GLSL.
//
//     nodes      x, y on the lattice; grade in the low byte, above it the clearance (NODE_CLEARANCE_SHIFT)
//     segments   node a, node b, slot, lowest and highest ground (16 bits each), length at a, ends
//     slots      category and place in the draw order, of each feature
//     styles     for each category a header of CATEGORY_TEXELS, then tuples of TUPLE_TEXELS and marks of one
#ifndef DECALGL_NETWORK_LAYOUT_H
#define DECALGL_NETWORK_LAYOUT_H

// Bits of a segment's ends.
#define LINE_ENDS_AT_A 1u
#define LINE_ENDS_AT_B 2u
#define PLAIN_A 4u  // cut, or straight on: no cap
#define PLAIN_B 8u
// The category, plus one, whose border cuts the cap at a and at b; 0: none.
#define CUT_A_SHIFT 8
#define CUT_B_SHIFT 16
#define CUT_MASK 255u

#define NODE_GRADE_MASK 255
#define NODE_CLEARANCE_SHIFT 8

// A category's header:
//     0   first tuple, tuples, reach, margin scale
//     1   caps of ends of grade 1, 2, 3, 4 and more
//     2   first mark, marks, period, offset
//     3   raster or -1, its length, slope correction, sketch's length
//     4   sketch's amplitude, 1 where the category shows anything
#define CATEGORY_TEXELS 5
// A tuple: lod, half width, share of the main colour, share of the raster; main colour; border colour.
#define TUPLE_TEXELS 3

// Fields reach this much beyond the widest border, so that the border itself is inside.
#define FIELD_SLACK 1.015625f

#endif

// The buffers of LOOPS, after figure 11 of the paper. Read by C++ and GLSL alike.
//
//     points       x, y                  vertices of arcs, in quanta of the lattice
//     bases        left, right           of each vertex: the ends of the base that it splits, with BASE_ flags
//     activations  x, y, error | radius, lowest | highest        of each vertex (activation.h)
//     styles       colour, half width    of each slot, topmost first; half width in quanta, of fills 0
//     nodes        words: a tree of nodes and lists
//
// A node covers a box. Words that lead on count from the node's first word; 0: nothing there.
//
//     primary     secondary node, side 0                 a leaf
//                 summary, side, width, height, child ...    side x side children of that many quanta, row by row
//     summary     error | radius, lowest | highest, list     the activation, around the middle of the node's box, of all
//                 that is not in the list: where it is not active, the list is all there is
//     secondary   list, side 0                           a leaf
//                 list, side, width, height, child ...
//     list        number of words that follow, groups
//     group       slot << 8 | count, primitive ...       topmost slot first; a slot may have several groups
//
// A primitive is a vertex: the triangle of its base and itself, of strokes the base or the sides that are edges. Or
// with EDGE_FLAG the edge from a vertex to the next one of its arc.
//
// That is 8 + 8 + 16 bytes a vertex, in place of 32 + 16 in the paper.
#ifndef DECALGL_LOOPS_LAYOUT_H
#define DECALGL_LOOPS_LAYOUT_H

#define LOOPS_POINT_MASK 0x1FFFFFFFu

// In the left end of a base: which of its ends generates it, and which sides of the triangle are edges.
#define BASE_FROM_RIGHT 0x80000000u
#define BASE_LEFT_EDGE 0x40000000u
#define BASE_RIGHT_EDGE 0x20000000u

// Of primitives.
#define EDGE_FLAG 0x80000000u
#define EDGE_FROM_NEXT 0x40000000u

#define GROUP_COUNT_BITS 8
#define GROUP_COUNT_MASK 255u

// Words of a leaf, and of another node before its children.
#define LEAF_WORDS 2u
#define NODE_WORDS 4u

// The most lists that a position may have: a secondary tree's path.
#define LOOPS_MOST_LISTS 12

#endif

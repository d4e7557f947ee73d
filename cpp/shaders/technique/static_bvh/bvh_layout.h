// The buffers of the BVH index, after figure 4.2 of Zechmeister 2020. Read by C++ and GLSL alike.
//
//     cells       first node, first object           of each cell, and one more that ends the last
//     nodes       box                                cell by cell: a complete binary tree, root first
//
//     segments    vertex, vertex                     lines: the objects of the cells
//     vertices    x, y                               of lines or rings, in quanta of the lattice
//     owners      slot                               lines: the line of each vertex
//
//     exteriors   subtree, slot, first, count        polygons: the objects of the cells
//     interiors   subtree                            of the other rings, cell by cell
//     quads       box                                nodes of all quad-trees; children are four in a row
//     quad_links  kind | count << 2, first           first child, or the leaf's segments
//     leaf_edges  vertex, vertex, first row, end row the ring's own edges, and closing ones
//
//     styles      colour bytes, half width           of each slot, topmost first
//
// A box is min x, min y, max x, max y and holds its border. Lattice points are the only places there are: a
// pixel's position is rounded to the nearest, so boxes side by side share no point and leave none out.
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

#endif

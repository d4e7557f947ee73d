// The cells of a view: what is active, in lists by place. Read by C++ and GLSL alike.
//
//     ground that is seen ──▶ buckets     bucket_entries[bucket]   first cell << LEVEL_BITS | level
//                             a bucket    cell_entries[cell]       first texel of its list; 0: an empty one
//                             2^level x   cell_texels              lists
//                             2^level cells
//
// A list is texels of four words, groups from the topmost slot to the lowest:
//
//     header   flags | edges that follow, slot, bits of the half width in quanta, 0
//     edge     x, y of both ends, bits of floats, in quanta from the cell's lower left corner
//
// Edges of fills are cut at the cell's left and right border; the corner of the cell is CELL_INSIDE or not. Those of
// strokes are whole, or end out of the stroke's reach. A stroke that is CELL_INSIDE covers all of the cell. Colours are
// looked up by slot (loops_styles, as in loops_layout.h), so others need no other cells.
#ifndef DECALGL_LOOPS_CELLS_LAYOUT_H
#define DECALGL_LOOPS_CELLS_LAYOUT_H

#define CELL_LEVEL_BITS 3
#define CELL_FINEST_LEVEL 6

#define CELL_LAST 0x80000000u
#define CELL_INSIDE 0x40000000u
#define CELL_STROKE 0x20000000u
#define CELL_EDGES 0x1FFFFFFFu

#endif

// Cell lists: what the cells of a static decal index hold. Read by C++ and GLSL alike.
//
//     map  ──▶  buckets       bucket_entries[bucket]   first cell << LEVEL_BITS | level
//               a bucket      cells[first + cell]      first texel << COUNT_BITS | texels
//               2^level x     texels                   four words each
//               2^level cells
//
// A list is words of 32 bits, groups from the topmost feature to the lowest:
//
//     header   HEADER | COVERS | LINE | CLIP | slot      slot: the decal's place in draw order, topmost first
//     point    MOVE | y << 15 | x                 an edge comes from the word before, unless MOVE is set
//     end      LIST_END                           fills the last texel
//
//     header  MOVE a   b    c   MOVE d   e   header ...        edges a-b, b-c and d-e
//
// Coordinates are lattice quanta from the cell's lower left corner, divided by the group's unit, plus a bias that
// centres the cell in the 15 bits (cell_bias). Ring edges are cut at the cell's border and have unit 1; ends of line
// segments may lie as far around the cell as 15 bits go, which is at least MAX_RADIUS units.
//
// `COVERS`: for a polygon, the corner of the cell is inside; for a line, the stroke covers the whole cell and
// no point follows. `CLIP`: the polygon is not drawn: the next group is, where it is inside of it.
#ifndef DECALGL_CELL_LISTS_H
#define DECALGL_CELL_LISTS_H

#define BUCKET_BITS 17  // a bucket is 2^17 quanta wide
#define BUCKET_QUANTA 131072
#define LEVEL_BITS 3
#define COARSEST_LEVEL 3  // of buckets with points, so that 15 bits suffice; a bucket without any has level 0
#define FINEST_LEVEL 6

// Levels of detail (levels.h): texels of the finest along a bucket's side, and how many a pixel must span to be
// drawn from them.
#define LEVEL_TEXELS 32
#define FEWEST_TEXELS 6

#define COUNT_BITS 6
#define COUNT_ESCAPE 63u  // that many or more: to the texel whose last word is LIST_END
#define EMPTY_LIST 0u     // of cells without one; the first texel is LIST_END alone

#define COORDINATE_BITS 15
#define COORDINATE_SPAN 32768
#define COORDINATE_MASK 0x7FFFu
#define MAX_RADIUS 8192

#define HEADER 0x80000000u
#define COVERS 0x40000000u
#define LINE 0x20000000u
#define CLIP 0x10000000u
#define SLOT_MASK 0x0FFFFFFFu
#define LIST_END 0x9FFFFFFFu
#define MOVE 0x40000000u

#endif

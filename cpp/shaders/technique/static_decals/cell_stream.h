// The cell stream: what the cells of a static decal grid hold. Read by C++ and GLSL alike.
//
// A cell is a run of 8-byte texels. Groups follow each other from the topmost feature to the lowest, each a
// header and its pieces:
//
//     header   x: HEADER_MARK | scale << 16 | covers << 21 | line << 22
//              y: slot of the feature in draw order, topmost first
//     piece    x: x0 | y0 << 16
//              y: x1 | y1 << 16
//
// A piece's x0 is never HEADER_MARK, so each texel says what it is.
//
// Coordinates are in lattice quanta from the cell's lower left corner, divided by 2^scale, plus
// COORDINATE_BIAS. A cell is CELL_QUANTA wide. Ring pieces are clipped to the cell and have scale 0; line
// pieces may reach as far around it as 16 bits go.
//
// `covers`: for a polygon, the corner of the cell is inside; for a line, the stroke covers the whole cell
// and no piece follows.
#ifndef DECALGL_CELL_STREAM_H
#define DECALGL_CELL_STREAM_H

#define CELL_BITS 15
#define CELL_QUANTA 32768
#define COORDINATE_BIAS 16384
#define COORDINATE_MAX 65534

#define HEADER_MARK 0xFFFFu
#define GROUP_SCALE_SHIFT 16
#define GROUP_SCALE_MASK 0x1Fu
#define GROUP_COVERS 0x00200000u
#define GROUP_LINE 0x00400000u

// Cells are numbered bucket by bucket, so that what lies together on the map lies together in memory.
#define BUCKET_BITS 5
#define BUCKET_CELLS 1024

#endif

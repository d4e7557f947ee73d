// Tiles of the screen with the segments that may be seen in them. Read by C++ and GLSL alike.
//
//     segments ──project──▶ placed segments ──count──▶ counts of each tile and run of segments ──prefix sum──▶
//              places in the list ──fill──▶ list: tile after tile, in each the segments in draw order
//
// A run is a stretch of neighbouring segments that one invocation takes, in order, and a tile's places go to the runs one
// after the other: so the list is sorted, without atomics and the same on every driver.
#ifndef DECALGL_BINS_LAYOUT_H
#define DECALGL_BINS_LAYOUT_H

#define TILE_SIDE 4    // pixels
#define BLOCK_TILES 8  // along a side of what is drawn or left out as one

// What is left of a segment in a view.
//     ends    on the map, relative to the base: from x, y; to x, y
//     joints  next x, y as bits; slot; flags
#define SEGMENT_BEGINS 1u  // of an open line
#define SEGMENT_ENDS 2u
#define SEGMENT_TURNS 4u         // at its end so much that the gap to the next one shows
#define SEGMENT_INSIDE_RIGHT 8u  // of a ring: its polygon lies to the right
#define SEGMENT_TURNED 16u       // where it begins, as it does at its end
//     arcs    of lines with patterns: where it begins along them, and how long it is (line_patterns.glsl)

#endif

// Style records of a static decal index: what several decals share of how they look. Read by C++ and GLSL alike.
//
//     decal_kinds[slot]    first texel << SCALE_BITS | scale      only where some decal is not plain
//
//     stroke   flags, miter limit, periods per quantum, marks | bands << BANDS_SHIFT
//              begin, end, begin width, end width     a mark, in periods and shares of the half width
//              reach, colour, -, -                    a band, in shares of the half width
//     hatch    flags, half width in spacings, sets of lines, -
//              per quantum x, y, phase, -             a set: spacings from a line, of a place in its bucket
//              per bucket x, y, -, -                  and of the bucket
//
// Flags, counts and colours are bits of a float. A line's words are in units of 2^scale quanta. The record at 0 is that of
// plain strokes and fills. The miter limit is the cosine of the largest turn that is still mitred.
//
// Lines whose corners and ends are not all round are JOINED: an edge is a bar alone; between two edges that follow each other
// there is a corner; an edge of no length is a dot, a disc or with SQUARE a square along x and y; a MOVE lifts the pen, even to
// where the run has come to. Where it has a pattern, a word follows each MOVE: how far along the period it is, as a fraction of
// PHASE_ONE. There a MOVE to where the run has come to keeps the corner, as the pattern begins anew where a ring closes, unless
// PHASE_LIFTS is set: another part of the line begins. Where it is TANGENT too, the pattern is measured along the ground: each
// edge begins with a MOVE, and before the phase comes its slant (features.h), the bits of a float.
//
//     plain    MOVE a   b    c          joined   MOVE a   a    b    c          with a pattern   MOVE a   phase   b    c
//              (a====(b====(c                    (a)  a====b<c====c            along the ground MOVE a   slant   phase   b
#ifndef DECALGL_STYLE_RECORDS_H
#define DECALGL_STYLE_RECORDS_H

#define SCALE_BITS 6
#define SCALE_MASK 63u
#define BANDS_SHIFT 8
#define COUNT_BITS_OF_MARKS 0xFFu
#define PHASE_ONE 536870912  // 2^29
#define PHASE_LIFTS 0x20000000u

#define STYLE_JOINED 1u
#define STYLE_MITER 2u  // else, where joined: bevel if set below, else round
#define STYLE_BEVEL 4u
#define STYLE_PATTERN 8u
#define STYLE_BANDS 16u
#define STYLE_TANGENT 32u  // as wide on the slope as on the map
#define STYLE_THOENY 64u
#define STYLE_HATCH 128u
#define STYLE_SQUARE 256u
#define STYLE_WIDENED 512u  // not in records: some stroke may become wider than it is

#endif

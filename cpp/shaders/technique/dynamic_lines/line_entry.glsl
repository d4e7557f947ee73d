// Which line an entry of a list is of, as a number: the slot, and the number of its band across the line. Bands of one line are
// slots that follow each other, and cover a pixel once.
#include "technique/dynamic_lines/line_styles.h"

uint line_entry(uint slot, uint kind) {
    return slot * (BAND_MASK + 1u) + (kind >> BAND_SHIFT & BAND_MASK);
}

uint slot_of_entry(uint entry) {
    return entry / (BAND_MASK + 1u);
}

bool is_same_line(uint a, uint b) {
    return slot_of_entry(a) + (a & BAND_MASK) == slot_of_entry(b) + (b & BAND_MASK);
}

// Inset and offset outlines: all segments that come near have an entry, with a word more. Of the entries of one line and band,
// the one with the least word is nearest and tells whether the pixel lies on the side that is kept.
const uint side_is_kept = 1u;
const uint segment_covers = 2u;
const uint shown_anyway = side_is_kept | segment_covers;  // of all other lines

// Of a distance from 0 on, the bits of which grow with it.
uint aside_word(float away, bool kept, bool covers) {
    return (floatBitsToUint(away) & ~shown_anyway) | (kept ? side_is_kept : 0u) | (covers ? segment_covers : 0u);
}

struct Asides {
    uint nearest;  // word
    bool covered;
};

const Asides no_asides = Asides(0xFFFFFFFFu, false);

void add_aside(inout Asides asides, uint word) {
    asides.nearest = min(asides.nearest, word);
    asides.covered = asides.covered || (word & segment_covers) != 0u;
}

bool is_shown(Asides asides) {
    return asides.covered && (asides.nearest & side_is_kept) != 0u;
}

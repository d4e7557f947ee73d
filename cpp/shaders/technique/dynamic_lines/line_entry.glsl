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

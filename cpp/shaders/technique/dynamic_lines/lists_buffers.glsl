// Lists of the lines that cover each pixel (Zechmeister 2020, section 4.3.2, figure 4.3).
//
//     heads     first entry of each pixel's list, or list_end
//     counts    entries of each pixel
//     next      the entry after each entry, or list_end
//     entries   which line, and its colour, straight alpha
//     asides    with SIDES: of each entry what line_entry.glsl says
//
//     pixel   heads[pixel] ──▶ next[..] ──▶ next[..] ──▶ list_end
//
// Entries are in whatever order fragments came. Which line is a number (line_entry.glsl) that follows the draw order: the
// highest lies on top.
const uint list_end = 0xFFFFFFFFu;

layout(std430, binding = 0) buffer Heads {
    uint heads[];
};
layout(std430, binding = 1) buffer Counts {
    uint counts[];
};
layout(std430, binding = 2) buffer Next {
    uint next[];
};
layout(std430, binding = 3) buffer Entries {
    uvec2 entries[];
};
// Of the picture: entries that were asked for, whether a list is too long to walk, and whether one is not sorted yet.
layout(std430, binding = 4) buffer Totals {
    uint entry_total;
    uint is_too_long;
    uint is_unsorted;
};

#ifdef SIDES
layout(std430, binding = 6) buffer AsideWords {
    uint asides[];
};
#endif

uniform int picture_width;  // of the rectangle that is drawn

uint list_of(ivec2 pixel) {
    return uint(pixel.y * picture_width + pixel.x);
}

// One run of segments: how many fall into each tile, or with FILL, the segments into their places.
//
// A segment falls into the tiles that the disc of its reach touches on its way, row by row of tiles:
//
//     +-----+-----+-----+
//     |     |   o-|--   |     in a row, between the ends of the stretch that comes near to it
//     +-----+-/---+-----+
//     |   --|o    |     |
//     +-----+-----+-----+
//
// WINDOWS    the list is longer than one block of the driver's
//
// A driver may end the loops of one run after so many turns in all: what is left is for the next run, which goes on where
// `progress` says.
#include "technique/dynamic_lines/bins_layout.h"
#include "technique/dynamic_lines/items.glsl"

uniform samplerBuffer segment_spans;
uniform samplerBuffer segment_reaches;
uniform ivec2 tile_grid;
uniform uint run_count;
uniform uint run_length;
uniform int most_turns;

layout(std430, binding = 0) readonly buffer Count {
    uint segment_count;
};
layout(std430, binding = 1) buffer Places {
    uint places[];  // of each tile, run by run
};
// Of each run, the segment and the row of its tiles to go on with.
layout(std430, binding = 3) buffer Progress {
    uvec2 progress[];
};
layout(std430, binding = 4) writeonly buffer Unfinished {
    uint is_unfinished;
};
#ifdef FILL
layout(std430, binding = 2) writeonly buffer List {
    uint list[];
};
#ifdef WINDOWS
layout(std430, binding = 5) writeonly buffer SecondList {
    uint second_list[];
};
layout(std430, binding = 6) writeonly buffer ThirdList {
    uint third_list[];
};
layout(std430, binding = 7) writeonly buffer FourthList {
    uint fourth_list[];
};
uniform uint window;  // entries of each

void set_entry(uint place, uint segment) {
    uint at = place % window, part = place / window;
    if (part == 0u) list[at] = segment;
    else if (part == 1u) second_list[at] = segment;
    else if (part == 2u) third_list[at] = segment;
    else fourth_list[at] = segment;
}
#else
void set_entry(uint place, uint segment) {
    list[place] = segment;
}
#endif
#endif

void add_to_tile(ivec2 tile, uint run, uint segment) {
    uint at = uint(tile.y * tile_grid.x + tile.x) * run_count + run;
    uint place = places[at];
    places[at] = place + 1u;
#ifdef FILL
    set_entry(place, segment);
#endif
}

// The first and last column of tiles in a row of them; the other way round where there are none.
ivec2 columns_in_row(vec4 span, float reach, int row) {
    vec2 edges = (vec2(row, row + 1) + vec2(-reach, reach) / float(TILE_SIDE)) * float(TILE_SIDE);
    float rise = span.w - span.y;
    vec2 shares = (edges - span.y) / (abs(rise) > 1e-6 ? rise : 1e-6);
    shares = abs(rise) > 1e-6 ? clamp(vec2(min(shares.x, shares.y), max(shares.x, shares.y)), 0.0, 1.0) : vec2(0.0, 1.0);
    vec2 x = span.x + shares * (span.z - span.x);
    vec2 range = vec2(min(x.x, x.y) - reach, max(x.x, x.y) + reach) / float(TILE_SIDE);
    return ivec2(clamp(floor(range), vec2(0.0, -1.0), vec2(tile_grid.x, tile_grid.x - 1)));
}

// The rows of tiles that a segment touches; the other way round where there are none.
ivec2 rows_of(vec4 span, float reach) {
    vec2 y = vec2(min(span.y, span.w) - reach, max(span.y, span.w) + reach) / float(TILE_SIDE);
    return reach >= 0.0 ? ivec2(clamp(floor(y), vec2(0.0), vec2(tile_grid.y - 1))) : ivec2(0, -1);
}

void main() {
    uint run = this_item();
    if (run >= item_count) return;
    uint first = run * run_length, segment = first + progress[run].x;
    uint end = min(first + run_length, segment_count);
    if (segment >= end) return;
    int row = int(progress[run].y), turns = 0;
    do {
        float reach = texelFetch(segment_reaches, int(segment)).r;
        vec4 span = texelFetch(segment_spans, int(segment));
        ivec2 rows = rows_of(span, reach);
        row = max(row, rows.x);
        if (row <= rows.y) {
            do {
                ivec2 columns = columns_in_row(span, reach, row);
                int column = columns.x;
                turns += max(columns.y - columns.x, 0) + 2;
                if (column <= columns.y) {
                    do {
                        add_to_tile(ivec2(column, row), run, segment);
                    } while (++column <= columns.y);
                }
            } while (++row <= rows.y && turns < most_turns);
        }
        if (row > rows.y) {
            ++segment;
            row = 0;
        }
    } while (segment < end && ++turns < most_turns);
    progress[run] = uvec2(segment - first, row);
    if (segment < end) is_unfinished = 1u;
}

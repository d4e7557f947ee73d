// Which features cover a point: one walk over the words of its cell.
//
// After Zechmeister 2020, algorithm 3.5, with a short list in draw order in place of a tree.
#include "technique/static_decals/cells.glsl"

uniform usamplerBuffer cell_texels;
#ifdef LENS_LISTS
uniform usamplerBuffer lens_texels;
#endif

// Four words of the lists.
uvec4 texel_at(int texel) {
#ifdef LENS_LISTS
    if (first_style != 0) return texelFetch(lens_texels, texel);
#endif
    return texelFetch(cell_texels, texel);
}

const uint no_slot = 0xFFFFFFFFu;

// Whether the walk from the cell's corner to a point crosses an edge (ring_cells.h). `corner` leads from the corner to
// the point. Both directions of an edge give the same answer.
bool crosses_walk(vec2 from, vec2 to, vec2 corner) {
    bool starts_left = from.x == corner.x;
    bool ends_left = to.x == corner.x;
    bool on_border = starts_left != ends_left && (starts_left ? from.y : to.y) >= 0.0;
    bool rises = from.y >= to.y;
    vec2 low = rises ? from : to;
    vec2 along = rises ? from - to : to - from;
    bool on_row = (from.y >= 0.0) != (to.y >= 0.0) && low.x * along.y >= low.y * along.x;
    return on_border != on_row;
}

// What a walk finds: with ONE_COLOR whether anything covers the point, with TRANSLUCENT the colours of all that does,
// front to back, and else the first slot that does.
#if (defined(TRANSLUCENT) || defined(BANDS)) && !defined(IDS)
#define FINDS_COLORS
#elif defined(ONE_COLOR) && !defined(IDS)
#define FINDS_ANY
#endif

#ifdef STYLES
#include "technique/static_decals/styled_point.glsl"
#else
#include "technique/static_decals/plain_point.glsl"
#endif

int walked_texels = 0;

// Walks the list of a cell until nothing behind can show.
Walk walk_cell(Cell cell, vec2 local) {
    Walk walk = begin_walk(cell, local);
    int texel = int(cell.entry >> COUNT_BITS);
    uint left = cell.entry & COUNT_ESCAPE;
    // At the loop's end, since some drivers go through a body once more for a test at its beginning.
    do {
        uvec4 words = texel_at(texel++);
        read_word(walk, words.x);
        read_word(walk, words.y);
        read_word(walk, words.z);
        read_word(walk, words.w);
        left = is_settled(walk) || words.w == LIST_END ? 0u : left == COUNT_ESCAPE ? left : left - 1u;
        ++walked_texels;
    } while (left != 0u);
    end_group(walk);
    return walk;
}

Walk walk_at(LatticePosition position) {
    Cell cell = cell_at(position.quantum);
    return walk_cell(cell, vec2(position.quantum - cell.corner) + position.fraction);
}

#ifdef ONE_COLOR
uniform vec4 one_color;
#endif

// Premultiplied.
vec4 color_at(LatticePosition position) {
    Walk walk = walk_at(position);
#if defined(FINDS_COLORS)
    return walk.found;
#elif defined(FINDS_ANY)
    return walk.found ? one_color : vec4(0.0);
#else
    return walk.found == no_slot ? vec4(0.0) : color_of(walk.found);
#endif
}

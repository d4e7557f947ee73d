// Which features cover a point: one walk over the words of its cell.
//
// After Zechmeister 2020, algorithm 3.5, with a short list in draw order in place of a tree. A fetch brings four words, and each is
// worked on without a branch, as a header and as a point at once: neighbouring pixels walk in step.
#include "technique/static_decals/cells.glsl"

uniform usamplerBuffer cell_texels;

const uint no_slot = 0xFFFFFFFFu;

// Whether a point is within a stroke's rectangle or the disc around the edge's end; `from` and `to` lead to the point
// from both ends of the edge. The disc around its beginning is that of the word before.
bool within_stroke(vec2 from, vec2 to, bool is_edge, float half_width2) {
    vec2 along = from - to;
    float length2 = dot(along, along);
    float t = dot(from, along);
    float across = from.x * along.y - from.y * along.x;
    bool beside = is_edge && across * across <= half_width2 * length2 && t > 0.0 && t <= length2;
    return beside || dot(to, to) <= half_width2;
}

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
#if defined(TRANSLUCENT) && !defined(IDS)
#define FINDS_COLORS
#elif defined(ONE_COLOR) && !defined(IDS)
#define FINDS_ANY
#endif

struct Walk {
    vec2 local;         // the point, in quanta from the cell's corner
    float bias;
    vec2 at;            // the point, in the group's coordinates
    float half_width2;  // of the group's line
    vec2 from;          // from the last word's point to the point
    bool line;
    bool covered;  // by the group, as far as it is read
    uint slot;
#if defined(FINDS_COLORS)
    vec4 found;
#elif defined(FINDS_ANY)
    bool found;
#else
    uint found;
#endif
};

Walk begin_walk(Cell cell, vec2 local) {
    Walk walk;
    walk.local = local;
    walk.bias = bias_of(cell.bits);
#ifdef ONE_WIDTH
    walk.at = local * line_scale + walk.bias;
    walk.half_width2 = line_half_width * line_half_width;
#else
    walk.at = local + walk.bias;
    walk.half_width2 = 0.0;
#endif
    walk.from = vec2(0.0);
    walk.line = false;
    walk.covered = false;
    walk.slot = no_slot;
#if defined(FINDS_COLORS)
    walk.found = vec4(0.0);
#elif defined(FINDS_ANY)
    walk.found = false;
#else
    walk.found = no_slot;
#endif
    return walk;
}

bool is_settled(Walk walk) {
#if defined(FINDS_COLORS)
    return walk.found.a >= 0.999;
#elif defined(FINDS_ANY)
    return walk.found || walk.covered;  // with one colour, all is shown
#else
    return walk.found != no_slot;
#endif
}

void end_group(inout Walk walk, bool ends) {
#if defined(FINDS_COLORS)
    if (ends && walk.covered && !is_settled(walk)) {
        vec4 straight = color_of(walk.slot);
        walk.found += (1.0 - walk.found.a) * vec4(straight.rgb * straight.a, straight.a);
    }
#elif defined(FINDS_ANY)
    walk.found = walk.found || (ends && walk.covered);
#else
    walk.found = ends && walk.covered && walk.found == no_slot && is_shown(walk.slot) ? walk.slot : walk.found;
#endif
}

void open_group(inout Walk walk, uint header, bool begins) {
    walk.slot = begins ? header & SLOT_MASK : walk.slot;
    walk.covered = begins ? (header & COVERS) != 0u : walk.covered;
#if defined(LINES) && defined(RINGS)
    walk.line = begins ? is_line(header) : walk.line;
#endif
#if defined(LINES) && defined(RINGS) && defined(ONE_WIDTH)
    walk.at = begins ? walk.local * (walk.line ? line_scale : 1.0) + walk.bias : walk.at;
#elif defined(LINES) && !defined(ONE_WIDTH)
    if (begins) {
        vec2 stroke = is_line(header) ? stroke_of(header) : vec2(1.0, 0.0);
        walk.at = walk.local * stroke.x + walk.bias;
        walk.half_width2 = stroke.y * stroke.y;
    }
#endif
}

// Every word is taken for a point and for a header at once, without a branch: neighbouring pixels walk in step.
void read_word(inout Walk walk, uint word) {
    vec2 to = walk.at - point_of(word);
    bool is_edge = !starts_edge(word);
    bool header = is_header(word);
    bool covered = walk.covered;
#ifdef LINES
    bool hit = within_stroke(walk.from, to, is_edge, walk.half_width2);
#endif
#ifdef RINGS
    // Rounded as what leads from the border's points is: not to be simplified.
    precise vec2 corner = walk.at - walk.bias;
    bool crossed = is_edge && crosses_walk(walk.from, to, corner);
#endif
#if defined(LINES) && defined(RINGS)
    covered = walk.line ? covered || hit : covered != crossed;
#elif defined(LINES)
    covered = covered || hit;
#elif defined(RINGS)
    covered = covered != crossed;
#endif
    walk.from = to;
    walk.covered = header ? walk.covered : covered;
    end_group(walk, header);
    open_group(walk, word, header);
}

// Walks the list of a cell until nothing behind can show.
Walk walk_cell(Cell cell, vec2 local) {
    Walk walk = begin_walk(cell, local);
    int texel = int(cell.entry >> COUNT_BITS);
    uint left = cell.entry & COUNT_ESCAPE;
    // At the loop's end, since some drivers go through a body once more for a test at its beginning.
    do {
        uvec4 words = texelFetch(cell_texels, texel++);
        read_word(walk, words.x);
        read_word(walk, words.y);
        read_word(walk, words.z);
        read_word(walk, words.w);
        left = is_settled(walk) || words.w == LIST_END ? 0u : left == COUNT_ESCAPE ? left : left - 1u;
    } while (left != 0u);
    end_group(walk, true);
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

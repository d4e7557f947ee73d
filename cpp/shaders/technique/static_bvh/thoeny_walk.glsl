// Lines by their coverage of the pixel in place of points of it (Thöny et al. 2018, section 3.5).
//
// The boxes of trees and cells are tested against the pixel's, so that lines are found which its centre does not
// lie on. A pixel looks into all cells that it reaches into, up to four thousand around its centre's. With NEAREST
// only the nearest line shows; else those that cover any of the pixel are laid over each other, of more than eight
// the topmost.
#include "technique/static_bvh/search.glsl"

const uint no_line = 0xFFFFFFFFu;
#ifdef NEAREST
const int most_lines = 1;
#else
const int most_lines = 8;
#endif

// Topmost first.
struct Lines {
    uint ranks[most_lines];
    vec4 colors[most_lines];  // premultiplied, and by the coverage
    float distance2;
};

void keep(inout Lines lines, Candidate line) {
#ifdef NEAREST
    bool ties = line.distance2 == lines.distance2 && line.rank < lines.ranks[0];
    if (line.covers && (line.distance2 < lines.distance2 || ties)) {
        lines.ranks[0] = line.rank;
        lines.colors[0] = line.color;
        lines.distance2 = line.distance2;
    }
#else
    // The line, and whatever it takes the place of, sinks to where it belongs: by constant indices, which leave the
    // arrays in registers.
    uint rank = line.covers ? line.rank : no_line;
    vec4 color = line.color;
    for (int i = 0; i < most_lines; ++i) {
        uint other = lines.ranks[i];
        vec4 below = lines.colors[i];
        bool again = rank == other && rank != no_line;
        // Of a line's segments the one that covers most of the pixel.
        bool takes = rank < other || (again && color.a > below.a);
        lines.ranks[i] = takes ? rank : other;
        lines.colors[i] = takes ? color : below;
        color = takes ? below : color;
        rank = again ? no_line : takes ? other : rank;
    }
#endif
}

// One node further, or on to the next cell, until an object is found.
void advance(inout Search search, inout int object, inout bool ended) {
    if (object >= 0 || ended) return;
    object = visit_node(search);
    if (object < 0 && search.node == 0u) ended = !next_cell(search);
}

// `foot`: the vectors for one pixel right and up, in quanta.
vec4 lines_at(ivec2 point, mat2 foot) {
    Lines lines;
    for (int i = 0; i < most_lines; ++i) {
        lines.ranks[i] = no_line;
        lines.colors[i] = vec4(0.0);
    }
    lines.distance2 = 1e38;
    Search search = search_around(point, half_pixel(foot));
    bool ended = false;
    // Mesa's software rasteriser ends all loops of a run after 65,535 turns: a turn is an object, or several nodes.
    do {
        int object = -1;
        advance(search, object, ended);
        advance(search, object, ended);
        advance(search, object, ended);
        advance(search, object, ended);
        if (object >= 0) keep(lines, candidate(object, point, foot));
    } while (!ended);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < most_lines; ++i) sum += (1.0 - sum.a) * lines.colors[i];
    return sum;
}

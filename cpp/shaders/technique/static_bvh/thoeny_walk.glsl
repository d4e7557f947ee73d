// Lines by their coverage of the pixel in place of points of it (Thöny et al. 2018, section 3.5).
//
// The boxes of trees and cells are tested against the pixel's, so that lines are found which its centre does not
// lie on. A pixel looks into all cells that it reaches into, up to four thousand around its centre's. With NEAREST
// only the nearest line shows; else those that cover any of the pixel are laid over each other, of more than eight
// the topmost.
#include "technique/static_bvh/search.glsl"

const uint no_line = 0xFFFFFFFFu;

// Not 0 where the driver ended the search of some pixel.
layout(std430, binding = 0) writeonly buffer Unfinished {
    uint unfinished;
};

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

// A line, and whatever it takes the place of, sinks to where it belongs. Of a line's segments the one that covers most of
// the pixel counts.
void sink(inout Lines lines, int place, inout uint rank, inout vec4 color) {
    uint other = lines.ranks[place];
    vec4 below = lines.colors[place];
    bool again = rank == other && rank != no_line;
    bool takes = rank < other || (again && color.a > below.a);
    lines.ranks[place] = takes ? rank : other;
    lines.colors[place] = takes ? color : below;
    color = takes ? below : color;
    rank = again ? no_line : takes ? other : rank;
}

void keep(inout Lines lines, Candidate line) {
#ifdef NEAREST
    bool ties = line.distance2 == lines.distance2 && line.rank < lines.ranks[0];
    if (line.covers && (line.distance2 < lines.distance2 || ties)) {
        lines.ranks[0] = line.rank;
        lines.colors[0] = line.color;
        lines.distance2 = line.distance2;
    }
#else
    // One by one: by constant indices, which leave the arrays in registers, and without a loop, whose turns would count.
    uint rank = line.covers ? line.rank : no_line;
    vec4 color = line.color;
    sink(lines, 0, rank, color);
    sink(lines, 1, rank, color);
    sink(lines, 2, rank, color);
    sink(lines, 3, rank, color);
    sink(lines, 4, rank, color);
    sink(lines, 5, rank, color);
    sink(lines, 6, rank, color);
    sink(lines, 7, rank, color);
#endif
}

// Front to back.
vec4 composed(Lines lines) {
    vec4 sum = lines.colors[0];
#ifndef NEAREST
    sum += (1.0 - sum.a) * lines.colors[1];
    sum += (1.0 - sum.a) * lines.colors[2];
    sum += (1.0 - sum.a) * lines.colors[3];
    sum += (1.0 - sum.a) * lines.colors[4];
    sum += (1.0 - sum.a) * lines.colors[5];
    sum += (1.0 - sum.a) * lines.colors[6];
    sum += (1.0 - sum.a) * lines.colors[7];
#endif
    return sum;
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
    if (!ended) unfinished = 1u;
    return composed(lines);
}

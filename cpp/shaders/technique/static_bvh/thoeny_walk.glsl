// Lines by their coverage of the pixel in place of points of it (Thöny et al. 2018, section 3.5).
//
// The boxes of trees and cells are tested against the pixel's, so that lines are found which its centre does not
// lie on. A pixel looks into all cells that it reaches into, up to four thousand around its centre's. With NEAREST
// only the nearest line shows; else those that cover any of the pixel are laid over each other, of more than eight
// the topmost.
const uint no_line = 0xFFFFFFFFu;
const int far_cells = 32;      // beyond the centre's cell, on each side
const int spare_cells = 2048;  // the same where the other side needs but one cell
#ifdef NEAREST
const int most_lines = 1;
#else
const int most_lines = 8;
#endif

// Topmost first.
struct Lines {
    uint slots[most_lines];
    vec4 colors[most_lines];  // premultiplied, and by the coverage
    float distance2;
};

void keep(inout Lines lines, Candidate line) {
#ifdef NEAREST
    bool ties = line.distance2 == lines.distance2 && line.slot < lines.slots[0];
    if (line.covers && (line.distance2 < lines.distance2 || ties)) {
        lines.slots[0] = line.slot;
        lines.colors[0] = line.color;
        lines.distance2 = line.distance2;
    }
#else
    // The line, and whatever it takes the place of, sinks to where it belongs: by constant indices, which leave the
    // arrays in registers.
    uint slot = line.covers ? line.slot : no_line;
    vec4 color = line.color;
    for (int i = 0; i < most_lines; ++i) {
        uint other = lines.slots[i];
        vec4 below = lines.colors[i];
        bool again = slot == other && slot != no_line;
        // Of a line's segments the one that covers most of the pixel.
        bool takes = slot < other || (again && color.a > below.a);
        lines.slots[i] = takes ? slot : other;
        lines.colors[i] = takes ? color : below;
        color = takes ? below : color;
        slot = again ? no_line : takes ? other : slot;
    }
#endif
}

// The cells that the pixel reaches into, row by row, and in each the leaves of its tree.
struct Search {
    ivec2 low, high;
    ivec2 place;
    Tree tree;
    uint node;  // 0 where the cell has no more
    ivec4 box;  // of the pixel
};

void enter(inout Search search) {
    search.tree = tree_in(search.place);
    search.node = search.tree.objects > 0u ? 1u : 0u;
}

// The next object whose box meets the pixel's, -1 where the cell has no more.
int next_in_cell(inout Search search) {
    Tree tree = search.tree;
    uint node = search.node;
    int object = -1;
    do {
        ivec4 box = texelFetch(bvh_nodes, tree.first_node + max(int(node) - 1, 0));
        bool meets = node != 0u && all(greaterThanEqual(search.box.zw, box.xy)) && all(lessThanEqual(search.box.xy, box.zw));
        bool is_leaf = node >= tree.first_leaf;
        if (meets && is_leaf) object = tree.first_object + int(node - tree.first_leaf);
        node = meets && !is_leaf ? 2u * node : next_right(node);
        if (node >= tree.first_leaf + tree.objects) node = 0u;
    } while (object < 0 && node != 0u);
    search.node = node;
    return object;
}

// The same through all cells. Trees are searched apart from what their objects cover, as a branch not taken costs as much
// in software.
int next_object(inout Search search) {
    int object = -1;
    bool ended = false;
    do {
        object = next_in_cell(search);
        if (object < 0) {
            bool row_ends = search.place.x >= search.high.x;
            search.place = row_ends ? ivec2(search.low.x, search.place.y + 1) : search.place + ivec2(1, 0);
            ended = search.place.y > search.high.y;
            if (!ended) enter(search);
        }
    } while (object < 0 && !ended);
    return object;
}

// `foot`: the vectors for one pixel right and up, in quanta.
vec4 lines_at(ivec2 point, mat2 foot) {
    Lines lines;
    for (int i = 0; i < most_lines; ++i) {
        lines.slots[i] = no_line;
        lines.colors[i] = vec4(0.0);
    }
    lines.distance2 = 1e38;
    ivec2 half_pixel = ivec2(min(ceil(0.5 * (abs(foot[0]) + abs(foot[1]))), vec2(5e8)));
    ivec2 last = grid_size - 1;
    ivec2 centre = clamp((point - grid_box.xy) / cell_size, ivec2(0), last);
    Search search;
    search.box = ivec4(point - half_pixel, point + half_pixel);
    search.low = clamp((search.box.xy - grid_box.xy) / cell_size, ivec2(0), last);
    search.high = clamp((search.box.zw - grid_box.xy) / cell_size, ivec2(0), last);
    // The cells of a level line are much lower than wide.
    ivec2 most = max(ivec2(far_cells), spare_cells / (search.high - search.low + 1).yx);
    search.low = max(search.low, centre - most);
    search.high = min(search.high, centre + most);
    search.place = search.low;
    enter(search);
    int object = -1;
    do {
        object = next_object(search);
        if (object >= 0) keep(lines, candidate(object, point, foot));
    } while (object >= 0);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < most_lines; ++i) sum += (1.0 - sum.a) * lines.colors[i];
    return sum;
}

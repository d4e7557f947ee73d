// Lines by their coverage of the pixel in place of points of it (Thöny et al. 2018, section 3.5).
//
// The boxes of trees and cells are tested against the pixel's, so that lines are found which its centre does not
// lie on. A pixel looks into all cells that it reaches into, up to four beyond its centre's. With NEAREST only the nearest line
// shows; else those that cover any of the pixel are laid over each other, of more than eight the topmost.
const uint no_line = 0xFFFFFFFFu;
const int most_cells = 4;
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
    int at = most_lines;
    for (int i = most_lines - 1; i >= 0; --i)
        if (line.slot <= lines.slots[i]) at = i;
    if (!line.covers || at == most_lines) return;
    bool again = lines.slots[at] == line.slot;
    // Of a line's segments the one that covers most of the pixel.
    if (again && lines.colors[at].a >= line.color.a) return;
    for (int i = most_lines - 1; i > at; --i) {
        if (!again) {
            lines.slots[i] = lines.slots[i - 1];
            lines.colors[i] = lines.colors[i - 1];
        }
    }
    lines.slots[at] = line.slot;
    lines.colors[at] = line.color;
#endif
}

void walk_cell(inout Lines lines, ivec2 place, ivec2 point, ivec2 half_pixel, mat2 foot) {
    Tree tree = tree_in(place);
    uint end = tree.first_leaf + tree.objects;
    uint node = tree.objects > 0u ? 1u : 0u;
    while (node != 0u && node < end) {
        ivec4 box = texelFetch(bvh_nodes, tree.first_node + int(node) - 1);
        bool inside = all(greaterThanEqual(point + half_pixel, box.xy)) && all(lessThanEqual(point - half_pixel, box.zw));
        bool is_leaf = node >= tree.first_leaf;
        if (inside && is_leaf) keep(lines, candidate(tree.first_object + int(node - tree.first_leaf), point, foot));
        node = inside && !is_leaf ? 2u * node : next_right(node);
    }
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
    ivec2 low = max(clamp((point - half_pixel - grid_box.xy) / cell_size, ivec2(0), last), centre - most_cells);
    ivec2 high = min(clamp((point + half_pixel - grid_box.xy) / cell_size, ivec2(0), last), centre + most_cells);
    for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) walk_cell(lines, ivec2(x, y), point, half_pixel, foot);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < most_lines; ++i) sum += (1.0 - sum.a) * lines.colors[i];
    return sum;
}

// All objects of a group whose boxes meet a pixel's: through the cells that it reaches into, row by row.
#include "technique/static_bvh/tree.glsl"

const int far_cells = 32;      // beyond the centre's cell, on each side
const int spare_cells = 2048;  // the same where the other side needs but one cell

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

// `foot`: the vectors for one pixel right and up, in quanta.
ivec2 half_pixel(mat2 foot) {
    return ivec2(min(ceil(0.5 * (abs(foot[0]) + abs(foot[1]))), vec2(5e8)));
}

Search search_around(ivec2 point, ivec2 half_size) {
    ivec2 last = grid_size - 1;
    ivec2 centre = clamp((point - grid_box.xy) / cell_size, ivec2(0), last);
    Search search;
    search.box = ivec4(point - half_size, point + half_size);
    search.low = clamp((search.box.xy - grid_box.xy) / cell_size, ivec2(0), last);
    search.high = clamp((search.box.zw - grid_box.xy) / cell_size, ivec2(0), last);
    // The cells of a level line are much lower than wide.
    ivec2 most = max(ivec2(far_cells), spare_cells / (search.high - search.low + 1).yx);
    search.low = max(search.low, centre - most);
    search.high = min(search.high, centre + most);
    search.place = search.low;
    enter(search);
    return search;
}

int cells_in(Search search) {
    ivec2 cells = search.high - search.low + 1;
    return cells.x * cells.y;
}

// Goes on by one node of the cell's tree. The object of a leaf that meets the pixel, else -1.
int visit_node(inout Search search) {
    Tree tree = search.tree;
    uint node = search.node;
    ivec4 box = texelFetch(bvh_nodes, tree.first_node + max(int(node) - 1, 0));
    bool meets = node != 0u && all(greaterThanEqual(search.box.zw, box.xy)) && all(lessThanEqual(search.box.xy, box.zw));
    bool is_leaf = node >= tree.first_leaf;
    search.node = meets && !is_leaf ? 2u * node : next_right(node);
    if (search.node >= tree.first_leaf + tree.objects) search.node = 0u;
    return meets && is_leaf ? tree.first_object + int(node - tree.first_leaf) : -1;
}

// The next object of the cell, -1 where it has no more.
int next_in_cell(inout Search search) {
    int object = -1;
    do {
        object = visit_node(search);
    } while (object < 0 && search.node != 0u);
    return object;
}

// Goes on to the next cell, and says whether there is one.
bool next_cell(inout Search search) {
    bool row_ends = search.place.x >= search.high.x;
    search.place = row_ends ? ivec2(search.low.x, search.place.y + 1) : search.place + ivec2(1, 0);
    bool found = search.place.y <= search.high.y;
    if (found) enter(search);
    return found;
}

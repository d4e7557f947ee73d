// The decal grid and the trees of its cells, on the GPU (bvh_layout.h, complete_tree.h).
#include "shared/view_block.h"
#include "shared/lattice_point.glsl"
#include "technique/static_bvh/bvh_layout.h"
#include "technique/static_bvh/integers.glsl"

uniform usamplerBuffer bvh_cells;
uniform isamplerBuffer bvh_nodes;
uniform usamplerBuffer bvh_styles;  // colour bytes, half width in quanta, look, rank
#if defined(CORNERS) || defined(HATCHES)
uniform usamplerBuffer bvh_looks;
#endif
uniform ivec4 grid_box;
uniform ivec2 grid_size;       // columns, rows
uniform ivec2 cell_size;       // quanta

bool holds(ivec4 box, ivec2 point) {
    return all(greaterThanEqual(point, box.xy)) && all(lessThanEqual(point, box.zw));
}

// A cell's tree: where its nodes and objects begin, and how many objects there are.
struct Tree {
    int first_node;
    int first_object;
    uint objects;
    uint first_leaf;
};

Tree tree_in(ivec2 place) {
    int cell = place.x + grid_size.x * place.y;
    uvec3 start = texelFetch(bvh_cells, cell).rgb;
    return Tree(int(start.x), int(start.y), start.z, start.z > 1u ? 2u << findMSB(start.z - 1u) : 1u);
}

// Columns and rows are tested apart: as one number, a column past the end would be a cell of the next row.
Tree tree_at(ivec2 point) {
    if (!holds(grid_box, point)) return Tree(0, 0, 0u, 1u);
    return tree_in((point - grid_box.xy) / cell_size);
}

// The node after the subtree of `node`, 0 after the last.
uint next_right(uint node) {
    node >>= findLSB(~node);
    return node == 0u ? 0u : node + 1u;
}

// Straight alpha.
vec4 color_of(uint slot) {
    return unpackUnorm4x8(texelFetch(bvh_styles, int(slot)).r);
}

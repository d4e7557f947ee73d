// Borders of fills in a pixel: the edges in the leaves of quad-trees that it reaches into, and hatch lines.
#include "technique/static_bvh/borders.glsl"
#include "technique/static_bvh/quad_trees.glsl"

const uint no_leaf = 0xFFFFFFFFu;
const int probe_count = 5;  // the middle and the corners of the pixel's part in a cell
const uint all_probes = 31u;

float area_of(ivec4 box) {
    vec2 size = vec2(max(box.zw - box.xy + 1, ivec2(0)));
    return size.x * size.y;
}

ivec4 common_box(ivec4 a, ivec4 b) {
    return ivec4(max(a.xy, b.xy), min(a.zw, b.zw));
}

// Those of a leaf's edges that pass through the pixel; and the rows in it at which the others, left of it, turn inside into
// outside. Those of a common vertex of two edges cancel out, and what is left is of a level edge, which is not in the list.
void add_leaf(inout Borders borders, uint leaf, ivec2 point, ivec4 part, mat2 foot) {
    uvec2 link = texelFetch(bvh_quad_links, int(leaf)).rg;
    ivec4 box = texelFetch(bvh_quads, int(leaf));
    int end = (link.x & QUAD_KIND_MASK) == QUAD_PARTIAL ? int(link.y + (link.x >> QUAD_COUNT_SHIFT)) : 0;
    int turns = 0;
    for (int i = int(link.y); i < end; ++i) {
        ivec4 edge = texelFetch(bvh_leaf_edges, i);
        bool is_left = true;
        if (uint(edge.x) != CLOSING_EDGE) {
            ivec2 a = texelFetch(bvh_ring_vertices, edge.x).rg, b = texelFetch(bvh_ring_vertices, edge.y).rg;
            vec2 along = vec2(b - a);
            float run = length(along);
            float distance = magnitude(wide_cross(point - a, b - a)) / run;
            float t = dot(vec2(point - a), along) / run;
            float reach = half_extent(along / run * foot) + 1e-6 * run + 1.0;
            bool beside = t < -reach || t > run + reach;
            is_left = distance >= 0.0;
            if (!beside && add_line(borders, vec2(along.y, -along.x) / run, distance, foot)) is_left = false;
        }
        for (int k = 0; k < 2; ++k) {
            int row = k == 0 ? edge.z : edge.w;
            bool cut = row == box.y || row == box.w + 1;
            if (is_left && !cut && row > part.y && row <= part.w) turns ^= row;
        }
    }
    // Rows of the map, upwards.
    if (turns != 0) {
        add_unknown(borders);
        if (borders.growth == vec2(0.0)) borders.growth = vec2(0.0, 1.0) * foot;
    }
}

ivec2 probe(ivec4 part, int index) {
    if (index == 4) return part.xy + (part.zw - part.xy) / 2;
    return ivec2((index & 1) != 0 ? part.z : part.x, (index & 2) != 0 ? part.w : part.y);
}

// One ring: which of the probes it holds.
uint add_ring(inout Borders borders, uint root, ivec2 point, ivec4 part, mat2 foot) {
    ivec4 box = texelFetch(bvh_quads, int(root));
    float seen = area_of(part) - area_of(common_box(part, box));
    uint inside = 0u;
    uint leaves[probe_count];
    for (int i = 0; i < probe_count; ++i) {
        ivec2 at = probe(part, i);
        uint leaf = holds(box, at) ? leaf_at(root, at) : no_leaf;
        bool is_new = leaf != no_leaf;
        for (int k = 0; k < i; ++k) is_new = is_new && leaves[k] != leaf;
        leaves[i] = leaf;
        if (is_new) {
            add_leaf(borders, leaf, point, part, foot);
            seen += area_of(common_box(part, texelFetch(bvh_quads, int(leaf))));
        }
        if (leaf != no_leaf) inside |= uint(leaf_holds(texelFetch(bvh_quad_links, int(leaf)).rg, at)) << i;
    }
    // There are leaves that no probe lies in.
    if (seen < 0.999 * area_of(part)) add_unknown(borders);
    return inside;
}

// An exterior, less its interiors: which of the probes it holds.
uint add_exterior(inout Borders borders, uvec4 exterior, ivec2 point, ivec4 part, mat2 foot) {
    uint inside = exterior.x != NO_SUBTREE ? add_ring(borders, exterior.x, point, part, foot) : 0u;
    for (uint i = exterior.z; i < exterior.z + exterior.w; ++i)
        inside ^= add_ring(borders, texelFetch(bvh_interiors, int(i)).r, point, part, foot);
    if (inside != 0u && inside != all_probes) {
        add_unknown(borders);
        if (borders.growth == vec2(0.0)) borders.growth = vec2(0.0, 1.0) * foot;
    }
    return inside;
}

#ifdef HATCHES
void add_hatch(inout Borders borders, int look, ivec2 point, mat2 foot) {
    int sets = int(texelFetch(bvh_looks, look).r);
    for (int i = 0; i < sets; ++i) {
        HatchLines lines = hatch_lines(look, i, point);
        vec2 steps = vec2(ivec2(lines.steps.xz)) / 4294967296.0;  // turns
        float turns = float(int(lines.phase - lines.reach)) / 4294967296.0;
        float steepness = max(length(steps), 1e-30);
        add_line(borders, steps / steepness, turns / steepness, foot);
    }
}
#endif

// Fills: whether an exterior of a cell, less its interiors, holds a point (quad_trees.h, fill_group.h).
#include "technique/static_bvh/tree.glsl"

uniform isamplerBuffer bvh_ring_vertices;
uniform usamplerBuffer bvh_exteriors;
uniform usamplerBuffer bvh_interiors;
uniform isamplerBuffer bvh_quads;
uniform usamplerBuffer bvh_quad_links;
uniform isamplerBuffer bvh_leaf_edges;

// An upward edge that owns the point's row, to the left of the point or through it.
bool crosses(int a, int b, ivec2 point) {
    ivec2 from = texelFetch(bvh_ring_vertices, a).rg;
    ivec2 to = texelFetch(bvh_ring_vertices, b).rg;
    return wide_cross(point - from, to - from).high >= 0;
}

bool leaf_holds(uvec2 link, ivec2 point) {
    uint kind = link.x & QUAD_KIND_MASK;
    bool inside = kind == QUAD_INSIDE;
    int end = kind == QUAD_PARTIAL ? int(link.y + (link.x >> QUAD_COUNT_SHIFT)) : 0;
    for (int i = int(link.y); i < end; ++i) {
        ivec4 edge = texelFetch(bvh_leaf_edges, i);
        if (edge.z <= point.y && point.y < edge.w)
            inside = inside != (uint(edge.x) == CLOSING_EDGE || crosses(edge.x, edge.y, point));
    }
    return inside;
}

bool ring_holds(uint node, ivec2 point) {
    if (!holds(texelFetch(bvh_quads, int(node)), point)) return false;
    uvec2 link = texelFetch(bvh_quad_links, int(node)).rg;
    while ((link.x & QUAD_KIND_MASK) == QUAD_INTERNAL) {
        // The first child ends where the others begin.
        ivec2 low = texelFetch(bvh_quads, int(link.y)).zw;
        uint child = link.y + (point.x > low.x ? 1u : 0u) + (point.y > low.y ? 2u : 0u);
        link = texelFetch(bvh_quad_links, int(child)).rg;
    }
    return leaf_holds(link, point);
}

bool exterior_holds(uvec4 exterior, ivec2 point) {
    bool inside = exterior.x != NO_SUBTREE && ring_holds(exterior.x, point);
    for (uint i = exterior.z; i < exterior.z + exterior.w; ++i)
        inside = inside != ring_holds(texelFetch(bvh_interiors, int(i)).r, point);
    return inside;
}

#ifdef HATCHES
// The phase, of which a whole turn is 2^32, that `count` steps of 64 bits lead to.
uint turned(uvec2 step, uint count) {
    uint high, low;
    umulExtended(step.y, count, high, low);
    return step.x * count + high;
}

// Whether the lines of a fill's hatch, if it has one, take in a point.
bool hatch_holds(int look, ivec2 point) {
    int sets = int(texelFetch(bvh_looks, look).r);
    bool inside = sets == 0;
    for (int i = 0; i < sets; ++i) {
        uvec4 steps = texelFetch(bvh_looks, look + 1 + 2 * i);
        uvec2 phases = texelFetch(bvh_looks, look + 2 + 2 * i).rg;
        uint phase = phases.x + turned(steps.xy, uint(point.x)) + turned(steps.zw, uint(point.y));
        inside = inside || min(phase, ~phase + 1u) <= phases.y;
    }
    return inside;
}
#endif

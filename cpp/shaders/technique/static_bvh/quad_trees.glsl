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

// The leaf below a node, whose box holds the point, in which it lies.
uint leaf_at(uint node, ivec2 point) {
    uvec2 link = texelFetch(bvh_quad_links, int(node)).rg;
    while ((link.x & QUAD_KIND_MASK) == QUAD_INTERNAL) {
        // The first child ends where the others begin.
        ivec2 low = texelFetch(bvh_quads, int(link.y)).zw;
        node = link.y + (point.x > low.x ? 1u : 0u) + (point.y > low.y ? 2u : 0u);
        link = texelFetch(bvh_quad_links, int(node)).rg;
    }
    return node;
}

bool ring_holds(uint node, ivec2 point) {
    if (!holds(texelFetch(bvh_quads, int(node)), point)) return false;
    return leaf_holds(texelFetch(bvh_quad_links, int(leaf_at(node, point))).rg, point);
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

// One set of a hatch's lines: what a quantum to the right and one upwards add to the phase, that of a point between the
// middles of two lines, from 0 on one to half a turn, and how far lines go.
struct HatchLines {
    uvec4 steps;
    uint phase;
    uint reach;
};

HatchLines hatch_lines(int look, int set, ivec2 point) {
    uvec4 steps = texelFetch(bvh_looks, look + 1 + 2 * set);
    uvec2 phases = texelFetch(bvh_looks, look + 2 + 2 * set).rg;
    uint phase = phases.x + turned(steps.xy, uint(point.x)) + turned(steps.zw, uint(point.y));
    return HatchLines(steps, min(phase, ~phase + 1u), phases.y);
}

// Whether the lines of a fill's hatch, if it has one, take in a point.
bool hatch_holds(int look, ivec2 point) {
    int sets = int(texelFetch(bvh_looks, look).r);
    bool inside = sets == 0;
    for (int i = 0; i < sets; ++i) {
        HatchLines lines = hatch_lines(look, i, point);
        inside = inside || lines.phase <= lines.reach;
    }
    return inside;
}
#endif

// Static decals of one data group, by the structures of Zechmeister 2020 (algorithm 3.5, section 4.4.1) and
// of Thöny et al. 2018 (section 3.2).
//
//     pixel ─▶ map position ─▶ cell ─▶ its tree, without a stack: down into boxes that hold the point,
//     else to the right; at a leaf a segment, or a ring's subtree; front to back until nothing shows behind
//
// RINGS          a group of polygons, else of lines
// UNSORTED       segments lie along a Hilbert curve: the walk goes on to the end
// NEAREST        the nearest line that covers the point is the only one seen
// COVERAGE       the mean of 32 points of the pixel's area, each walked by itself
// IDS            writes 1 + slot of the topmost feature at the centre, nothing where there is none
#include "shared/ray.glsl"
#include "technique/static_bvh/tree.glsl"
#ifdef RINGS
#include "technique/static_bvh/quad_trees.glsl"
#else
#include "technique/static_bvh/strokes.glsl"
#endif

uniform usampler2D position_texture;
#ifdef COVERAGE
#include "shared/sample_offsets.glsl"
uniform sampler2D surface_texture;
#endif

const uint no_slot = 0xFFFFFFFFu;

// What has been found so far. In draw order, `slot` is the last feature added to the colour; else the one to
// be shown.
struct Found {
    vec4 sum;
    uint slot;
    float distance2;
    bool done;
};

void add_color(inout Found found, uint slot) {
    found.slot = slot;
#ifdef IDS
    found.done = true;
#else
    vec4 straight = color_of(slot);
    found.sum += (1.0 - found.sum.a) * vec4(straight.rgb * straight.a, straight.a);
    found.done = found.sum.a >= 0.999;
#endif
}

// A leaf of the cell's tree whose box holds the point.
void visit(inout Found found, int object, ivec2 point) {
#if defined(RINGS)
    uvec4 exterior = texelFetch(bvh_exteriors, object);
    if (exterior_holds(exterior, point)) add_color(found, exterior.y);
#else
    Candidate line = candidate(object, point);
    bool covers = line.distance2 < out_of_reach;
#if defined(NEAREST)
    bool ties = line.distance2 == found.distance2 && line.slot < found.slot;
    if (covers && (line.distance2 < found.distance2 || ties)) {
        found.slot = line.slot;
        found.distance2 = line.distance2;
    }
#elif defined(UNSORTED)
    if (covers) found.slot = min(found.slot, line.slot);
#else
    // The segments of a line follow each other, and it covers a point once.
    if (covers && line.slot != found.slot) add_color(found, line.slot);
#endif
#endif
}

Found walk(ivec2 point) {
    Found found = Found(vec4(0.0), no_slot, 1e38, false);
    Tree tree = tree_at(point);
    uint end = tree.first_leaf + tree.objects;
    uint node = tree.objects > 0u ? 1u : 0u;
    // What lies past the last object's leaf is empty and not stored.
    while (node != 0u && node < end && !found.done) {
        bool inside = holds(texelFetch(bvh_nodes, tree.first_node + int(node) - 1), point);
        bool is_leaf = node >= tree.first_leaf;
        if (inside && is_leaf) visit(found, tree.first_object + int(node - tree.first_leaf), point);
        node = inside && !is_leaf ? 2u * node : next_right(node);
    }
#if !defined(RINGS) && (defined(NEAREST) || defined(UNSORTED))
    if (found.slot != no_slot) add_color(found, found.slot);
#endif
    return found;
}

#ifdef IDS
uniform uint first_slot;
layout(location = 0) out uint id;

void main() {
    Position position = unpack_position(texelFetch(position_texture, ivec2(gl_FragCoord.xy), 0));
    if (is_sky(position)) discard;
    Found found = walk(lattice_point(position, vec2(0.0)));
    if (found.slot == no_slot) discard;
    id = first_slot + found.slot + 1u;
}
#else
layout(location = 0) out vec4 color;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    Position position = unpack_position(texelFetch(position_texture, pixel, 0));
    color = vec4(0.0);
    if (is_sky(position)) return;
#ifdef COVERAGE
    vec4 surface = texelFetch(surface_texture, pixel, 0);
    mat2 foot = footprint(pixel_from_centre(), surface.xy, surface.z);
    for (int i = 0; i < sample_count; ++i)
        color += walk(lattice_point(position, foot * sample_offsets[i])).sum / float(sample_count);
#else
    color = walk(lattice_point(position, vec2(0.0))).sum;
#endif
}
#endif

// From a map position to the lists of what may cover it: down the primary tree to a leaf, and along a path of its
// secondary tree (loops_layout.h).
#include "shared/lattice_point.glsl"
#include "technique/loops/loops_layout.h"

uniform usamplerBuffer loops_nodes;
uniform ivec4 root_box;     // of the terrain, in quanta

uint word(int place) {
    return texelFetch(loops_nodes, place).r;
}

// Words of a list, from the first group on.
struct List {
    int next;
    int end;
};

#ifdef PATHS
const int most_lists = LOOPS_MOST_LISTS;
#else
const int most_lists = 1;
#endif

struct Lists {
    List at[most_lists];
};

// The child that holds the point, whose box takes the place of its parent's; -1 where there is nothing.
int child_at(int node, int side, ivec2 point, inout ivec4 box) {
    ivec2 size = ivec2(uvec2(word(node + 2), word(node + 3)));
    ivec2 offset = point - box.xy;
    // Division of integers is slow; that of floats is off by one at most, as there are few children.
    ivec2 place = ivec2(vec2(offset) / vec2(size));
    place -= ivec2(greaterThan(place * size, offset));
    place += ivec2(lessThanEqual((place + 1) * size, offset));
    uint step = word(node + int(NODE_WORDS) + place.y * side + place.x);
    box.xy += place * size;
    box.zw = min(box.xy + size - 1, box.zw);
    return step == 0u ? -1 : node + int(step);
}

List list_of(int node) {
    int step = node < 0 ? 0 : int(word(node));
    if (step == 0) return List(0, 0);
    int begin = node + step;
    return List(begin + 1, begin + 1 + int(word(begin)));
}

Lists lists_at(ivec2 point) {
    ivec4 box = root_box;
    bool inside = all(greaterThanEqual(point, box.xy)) && all(lessThanEqual(point, box.zw));
    int node = inside ? 0 : -1;
    int side = inside ? int(word(1)) : 0;
    while (side > 0) {
        node = child_at(node, side, point, box);
        side = node < 0 ? 0 : int(word(node + 1));
    }
    if (node >= 0) node += int(word(node));
    Lists lists;
    lists.at[0] = list_of(node);
#ifdef PATHS
    for (int i = 1; i < most_lists; ++i) {
        side = node < 0 ? 0 : int(word(node + 1));
        node = side > 0 ? child_at(node, side, point, box) : -1;
        lists.at[i] = list_of(node);
    }
#endif
    return lists;
}

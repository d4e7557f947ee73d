// The features at one point, front to back, until nothing shows behind.
const uint no_slot = 0xFFFFFFFFu;

// What has been found so far. In draw order, `slot` is the last feature added to the colour, with BANDS the one
// to be added next; else the one to be shown, of that rank. `seen` is the topmost that shows.
struct Found {
    vec4 sum;
    uint seen;
    uint slot;
    uint rank;
    float distance2;
    float across;
    bool done;
};

void add_color(inout Found found, uint slot, float across) {
#ifdef BANDS
    vec4 straight = band_color(slot, across);
#else
    vec4 straight = color_of(slot);
#endif
    if (found.seen == no_slot && straight.a > 0.0) found.seen = slot;
    found.sum += (1.0 - found.sum.a) * vec4(straight.rgb * straight.a, straight.a);
#ifdef IDS
    found.done = found.seen != no_slot;
#else
    found.done = found.sum.a >= 0.999;
#endif
}

#ifdef BANDS
// A stroke's colour is known once all its segments have been seen.
void settle(inout Found found) {
    if (found.slot != no_slot) add_color(found, found.slot, found.across);
    found.slot = no_slot;
}
#endif

// The segments of a line follow each other, and it covers a point once.
void add_in_order(inout Found found, uint slot, float across) {
#ifdef BANDS
    if (slot != found.slot) {
        settle(found);
        found.across = across;
    }
    found.across = min(found.across, across);
#else
    if (slot != found.slot) add_color(found, slot, across);
#endif
    found.slot = slot;
}

#if defined(NEAREST) || defined(UNSORTED)
// The one line to be shown.
void keep(inout Found found, Candidate line) {
#ifdef NEAREST
    bool better = line.distance2 < found.distance2 || (line.distance2 == found.distance2 && line.rank < found.rank);
#else
    bool better = line.rank < found.rank || (line.rank == found.rank && line.across < found.across);
#endif
    if (line.covers && better) {
        found.slot = line.slot;
        found.rank = line.rank;
        found.distance2 = line.distance2;
        found.across = line.across;
    }
}
#endif

// A leaf of the cell's tree whose box holds the point.
void visit(inout Found found, int object, ivec2 point) {
#if defined(RINGS)
    uvec4 exterior = texelFetch(bvh_exteriors, object);
    bool covers = exterior_holds(exterior, point);
#ifdef HATCHES
    covers = covers && hatch_holds(int(texelFetch(bvh_styles, int(exterior.y)).b), point);
#endif
    if (covers) add_in_order(found, exterior.y, 0.0);
#elif defined(BOTH)
    uvec2 kind = texelFetch(bvh_objects, object).rg;
    bool is_stroke = (kind.x & STROKE_OBJECT) != 0u;
    Candidate line = candidate(is_stroke ? int(kind.x & ~STROKE_OBJECT) : 0, point);
    uint place = is_stroke ? kind.y : kind.x;
#if !defined(INSET) && !defined(OFFSET)
    if (is_stroke) place = NO_EXTERIOR;
#endif
    bool wanted = place != NO_EXTERIOR && (!is_stroke || line.covers);
    uvec4 exterior = wanted ? texelFetch(bvh_exteriors, int(place)) : uvec4(NO_SUBTREE, 0u, 0u, 0u);
    bool inside = exterior_holds(exterior, point);
    bool covers = inside;
#ifdef HATCHES
    uint fill = is_stroke || !wanted ? line.slot : exterior.y;
    covers = covers && (is_stroke || hatch_holds(int(texelFetch(bvh_styles, int(fill)).b), point));
#endif
#if defined(INSET)
    if (is_stroke) covers = line.covers && inside;
#elif defined(OFFSET)
    if (is_stroke) covers = line.covers && !inside;
#else
    if (is_stroke) covers = line.covers;
#endif
    if (covers) add_in_order(found, is_stroke ? line.slot : exterior.y, is_stroke ? line.across : 0.0);
#else
    Candidate line = candidate(object, point);
#if defined(NEAREST) || defined(UNSORTED)
    keep(found, line);
#else
    if (line.covers) add_in_order(found, line.slot, line.across);
#endif
#endif
}

Found walk(ivec2 point) {
    Found found = Found(vec4(0.0), no_slot, no_slot, no_slot, 1e38, 1e38, false);
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
#if defined(NEAREST) || defined(UNSORTED)
    if (found.slot != no_slot) add_color(found, found.slot, found.across);
#elif defined(BANDS)
    if (!found.done) settle(found);
#endif
    return found;
}

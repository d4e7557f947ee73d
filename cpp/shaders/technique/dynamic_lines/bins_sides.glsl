// On which side of its ring a point lies, told by the nearest segment: inset and offset outlines keep one side alone.
//
//      inside  /\  outside      beyond the end of a segment the corner tells: outside of a convex one everything that is
//             /  \              nearest to the corner lies outside
//
// A corner is looked at from the segment that ends there. All places in pixels from the pixel's centre.

const float nothing_near = 1e30;

bool is_kept(bool is_inside, uint kind) {
    return (kind & (is_inside ? OUTSIDE_ONLY : INSIDE_ONLY)) == 0u;
}

// Whether the segment comes nearer to a point than `nearest`, which then says how near; and whether the point is inside.
bvec2 looked_aside(inout float nearest, SeenSegment seen, vec2 at) {
    vec2 from = seen.segment.from - at, way = seen.segment.to - seen.segment.from;
    float share = -dot(from, way) / max(dot(way, way), 1e-12);
    float away = length(from + clamp(share, 0.0, 1.0) * way);
    float turn = cross_product(seen.direction, seen.outgoing);
    float left = cross_product(seen.direction, -from);
    if (share >= 1.0 && !finishes(seen) && abs(turn) > 1e-6) left = -turn;
    bool is_nearer = away < nearest && (share >= 0.0 || begins(seen));
    nearest = is_nearer ? away : nearest;
    return bvec2(is_nearer, (left > 0.0) == seen.inside_left);
}

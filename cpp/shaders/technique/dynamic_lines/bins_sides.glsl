// On which side of its ring a place lies: all segments in turn, of which the nearest tells (ring_sides.glsl). A corner is
// looked at from the segment that ends there. All places in pixels from the pixel's centre.
#include "technique/dynamic_lines/ring_sides.glsl"

const float nothing_near = 1e30;

// Whether the segment comes nearer to a point than `nearest`, which then says how near; and whether the point is inside.
bvec2 looked_aside(inout float nearest, SeenSegment seen, vec2 at) {
    vec2 from = seen.segment.from - at, way = seen.segment.to - seen.segment.from;
    float share = -dot(from, way) / max(dot(way, way), 1e-12);
    float away = length(from + clamp(share, 0.0, 1.0) * way);
    float turn = share >= 1.0 && !finishes(seen) ? cross_product(seen.direction, seen.outgoing) : 0.0;
    bool is_nearer = away < nearest && (share >= 0.0 || begins(seen));
    nearest = is_nearer ? away : nearest;
    return bvec2(is_nearer, is_inside_ring(from, seen.direction, turn, seen.inside_left));
}

// On which side of its ring a point lies, told by the nearest segment: inset and offset outlines keep one side alone.
//
//      inside  /\  outside      beyond the end of a segment the corner tells: outside of a convex one everything that is
//             /  \              nearest to the corner lies outside
#include "shared/stroke.glsl"
#include "technique/dynamic_lines/line_styles.h"

bool is_kept(bool is_inside, uint kind) {
    return (kind & (is_inside ? OUTSIDE_ONLY : INSIDE_ONLY)) == 0u;
}

// `from`: from the point to the segment. `turn`: the sine at the corner that is nearest, 0 beside the segment.
// `inside_left`: whether the polygon lies to the segment's left.
bool is_inside_ring(vec2 from, vec2 direction, float turn, bool inside_left) {
    float left = abs(turn) > 1e-6 ? -turn : cross_product(direction, -from);
    return (left > 0.0) == inside_left;
}

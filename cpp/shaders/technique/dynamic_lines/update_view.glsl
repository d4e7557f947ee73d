// Whether anything of a segment may show in the picture.
//
// A pixel is covered by lines that lie near its own place on the ground, or on its plane; so what counts of a segment is
// the curtain above and below it, over all heights of the terrain, and what lies within its reach of that:
//
//     highest  +-----------+        at most reach_px pixels on the screen and reach_metres metres in space away
//              |  a --- b  |
//     lowest   +-----------+
//
// It is left out where all of this is outside one and the same side of the picture, or behind the camera: so one that
// crosses the picture stays, wherever its ends are.
#include "shared/view_block.h"

uniform vec2 ground_heights;  // the lowest and the highest, metres from the view's base
uniform float reach_px;
uniform float reach_metres;

vec4 row_of_clip(int row) {
    return vec4(clip_from_base[0][row], clip_from_base[1][row], clip_from_base[2][row], clip_from_base[3][row]);
}

// Whether the curtain, with its reach, is somewhere on the inner side of a plane.
bool reaches(vec4 plane, vec2 a, vec2 b) {
    float across = max(dot(plane.xy, a), dot(plane.xy, b));
    float upwards = max(plane.z * ground_heights.x, plane.z * ground_heights.y);
    return across + upwards + plane.w + reach_metres * length(plane.xyz) >= 0.0;
}

bool may_show(vec2 a, vec2 b) {
    vec4 x = row_of_clip(0), y = row_of_clip(1), w = row_of_clip(3);
    vec2 wide = 1.0 + 2.0 * reach_px / spacing.zw;
    return reaches(wide.x * w + x, a, b) && reaches(wide.x * w - x, a, b) &&
           reaches(wide.y * w + y, a, b) && reaches(wide.y * w - y, a, b) && reaches(w, a, b);
}

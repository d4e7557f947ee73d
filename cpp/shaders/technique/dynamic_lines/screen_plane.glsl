// Where a map position shows, on the plane of the ground that a pixel sees: the meaning of widths in pixels.
//
//     the centre line is dropped onto the plane at the pixel's point P and projected; a pixel is inside when the distance
//     on the screen is at most half the width
//
// With the offset a on the map from P, gradient g and d = (a, g.a), a step of d moves on the screen, in pixels, by
//
//     (x, y) = (d.ex, d.ey) / (1 + d.f / w)          ex, ey: pixels for a metre, less what the perspective takes
//                                                    w: planar depth of P
//
// which is exact on all of the plane. Nothing of neighbouring pixels is asked for, and no division goes to infinity where
// the plane is seen edge-on.
#include "shared/ray.glsl"

struct ScreenPlane {
    vec2 place;      // of the pixel's point on the map, relative to the base
    mat2 to_screen;  // columns: pixels for a metre east and north
    vec2 lean;       // how the depth grows with a metre east and north, as a share of it
    float pixels_per_metre;  // seen head-on
};

ScreenPlane screen_plane(vec2 pixel, vec4 surface) {
    vec2 gradient = surface.xy;
    float distance = surface.z;
    vec3 right = ray_origin_dx.xyz + distance * ray_direction_dx.xyz;  // metres a pixel
    vec3 up = ray_origin_dy.xyz + distance * ray_direction_dy.xyz;
    bool perspective = dot(ray_direction_dx.xyz, ray_direction_dx.xyz) > 0.0;
    vec3 depth = perspective ? forward.xyz / (forward.w + distance) : vec3(0.0);
    vec3 x = right / dot(right, right) - pixel.x * depth;
    vec3 y = up / dot(up, up) - pixel.y * depth;
    vec2 to_x = x.xy + x.z * gradient, to_y = y.xy + y.z * gradient;
    ScreenPlane plane;
    plane.place = (ray_origin_at(pixel) + distance * ray_direction_at(pixel)).xy;
    plane.to_screen = mat2(to_x.x, to_y.x, to_x.y, to_y.y);
    plane.lean = depth.xy + depth.z * gradient;
    plane.pixels_per_metre = inversesqrt(dot(right, right));
    return plane;
}

const float nearest_share = 1e-3;  // of the pixel's depth: what lies nearer to the eye is cut off

// A segment on the screen, in pixels from the pixel's centre.
struct ScreenSegment {
    vec2 from;
    vec2 to;
    bool seen;
};

ScreenSegment on_screen(ScreenPlane plane, vec4 ends) {
    vec2 a = ends.xy - plane.place, b = ends.zw - plane.place;
    float depth_a = 1.0 + dot(plane.lean, a), depth_b = 1.0 + dot(plane.lean, b);
    vec2 from = plane.to_screen * a, to = plane.to_screen * b;
    float rise = depth_b - depth_a;
    float cut = clamp((nearest_share - depth_a) / (abs(rise) > 1e-12 ? rise : 1e-12), 0.0, 1.0);
    vec2 middle = mix(from, to, cut);
    bool near_a = depth_a < nearest_share, near_b = depth_b < nearest_share;
    from = near_a ? middle : from;
    to = near_b ? middle : to;
    return ScreenSegment(from / max(depth_a, nearest_share), to / max(depth_b, nearest_share), !(near_a && near_b));
}

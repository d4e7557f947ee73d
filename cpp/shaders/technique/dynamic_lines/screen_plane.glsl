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
//
// The line's own ground counts too: where the ground under the nearest point of the centre line is seen farther than
// `ground_reach` from where the plane has it, the line is not there. Else a plane that is seen edge-on
// would show what lies far behind a ridge.
#include "shared/ray.glsl"
#include "technique/dynamic_lines/ground_height.glsl"
#include "technique/dynamic_lines/ground_reach.glsl"

struct ScreenPlane {
    vec2 place;      // of the pixel's point on the map, relative to the base
    float height;
    vec2 gradient;
    mat2 to_screen;  // columns: pixels for a metre east and north
    vec2 up;         // pixels for a metre upwards
    vec2 lean;       // how the depth grows with a metre east and north, as a share of it
    float lean_up;
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
    vec3 point = ray_origin_at(pixel) + distance * ray_direction_at(pixel);
    return ScreenPlane(point.xy, point.z, gradient, mat2(to_x.x, to_y.x, to_x.y, to_y.y), vec2(x.z, y.z),
                       depth.xy + depth.z * gradient, depth.z, inversesqrt(dot(right, right)));
}

const float nearest_share = 1e-3;  // of the pixel's depth: what lies nearer to the eye is cut off

// A segment on the screen, in pixels from the pixel's centre.
struct ScreenSegment {
    vec2 from;
    vec2 to;
    bool seen;
    vec2 depths;  // of both ends, as shares of the pixel's
    vec2 shares;  // of the way on the map, which differ from 0 and 1 where it is cut off
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
    vec2 depths = max(vec2(depth_a, depth_b), nearest_share);
    vec2 shares = vec2(near_a ? cut : 0.0, near_b ? cut : 1.0);
    return ScreenSegment(from / depths.x, to / depths.y, !(near_a && near_b), depths, shares);
}

// How far along the segment on the screen its nearest point to the pixel's centre lies, on its line: from 0 to 1 between the
// ends.
float foot_share(ScreenSegment segment) {
    vec2 way = segment.to - segment.from;
    return -dot(segment.from, way) / max(dot(way, way), 1e-12);
}

// Of the pixel's centre.
float distance_to(ScreenSegment segment) {
    return length(mix(segment.from, segment.to, clamp(foot_share(segment), 0.0, 1.0)));
}

// The share of the way on the map where it is so much on the screen, and how fast that grows.
vec2 share_on_map(ScreenSegment segment, float share) {
    float depth = max(mix(segment.depths.y, segment.depths.x, share), 1e-6 * segment.depths.y);
    float on_map = share * segment.depths.x / depth;
    float growth = segment.depths.x * segment.depths.y / (depth * depth);
    float stretch = segment.shares.y - segment.shares.x;
    return vec2(segment.shares.x + stretch * on_map, stretch * growth);
}

// Whether the ground under the segment is seen where the plane has it. Where there is no ground, there is nothing to ask.
bool is_on_ground(ScreenPlane plane, ScreenSegment segment, vec4 ends, float half_width) {
    float share = clamp(foot_share(segment), 0.0, 1.0);
    vec2 foot = mix(ends.xy, ends.zw, share_on_map(segment, share).x), a = foot - plane.place;
    float ground = ground_height(foot);
    if (ground < missing_ground) return true;
    float rise = ground - plane.height - dot(plane.gradient, a);
    float depth = max(1.0 + dot(plane.lean, a) + rise * plane.lean_up, nearest_share);
    vec2 seen = (plane.to_screen * a + rise * plane.up) / depth;
    return distance(seen, mix(segment.from, segment.to, share)) <= ground_reach(half_width);
}

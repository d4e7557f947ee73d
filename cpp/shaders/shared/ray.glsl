// Rays through pixel centres, and how a pixel's square lies on the surface's tangent plane.
#include "shared/view_block.h"

// This pixel's centre, in pixels from the centre of the whole picture, y upwards.
vec2 pixel_from_centre() {
    return gl_FragCoord.xy + vec2(picture.xy) - 0.5 * spacing.zw;
}

vec3 ray_direction_at(vec2 pixel) {
    return ray_direction.xyz + pixel.x * ray_direction_dx.xyz + pixel.y * ray_direction_dy.xyz;
}

vec3 ray_origin_at(vec2 pixel) {
    return pixel.x * ray_origin_dx.xyz + pixel.y * ray_origin_dy.xyz;
}

// Metres on the map for one pixel to the right (column 0) and one up (column 1), on the plane with this gradient
// at this distance along the ray. From the plane itself, not from neighbouring pixels: those lie at silhouettes.
mat2 footprint(vec2 pixel, vec2 gradient, float distance) {
    vec3 normal = vec3(-gradient, 1.0);
    vec3 direction = ray_direction_at(pixel);
    vec3 dx = ray_origin_dx.xyz + distance * ray_direction_dx.xyz;
    vec3 dy = ray_origin_dy.xyz + distance * ray_direction_dy.xyz;
    float along = dot(normal, direction);
    return mat2(dx.xy - direction.xy * (dot(normal, dx) / along), dy.xy - direction.xy * (dot(normal, dy) / along));
}

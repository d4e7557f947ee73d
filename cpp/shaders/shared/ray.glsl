// Rays through pixel centres or samples, and how a pixel's square lies on the surface's tangent plane.
//
// MULTISAMPLED   the driver's samples of a pixel are shaded one by one
// GATHERED       texels are samples of pixels from anywhere in the picture
#include "shared/view_block.h"
#ifdef GATHERED
#include "shared/gathered.glsl"
#endif

// The sample in hand, in pixels from the centre of the whole picture, y upwards: this pixel's centre, but for
// jittered pictures.
vec2 pixel_from_centre() {
#ifdef MULTISAMPLED
    vec2 place = floor(gl_FragCoord.xy) + gl_SamplePosition;
#elif defined(GATHERED)
    vec2 place = vec2(gathered_pixel()) + 0.5 + gathered_offset();
#else
    vec2 place = gl_FragCoord.xy;
#endif
    return place + vec2(picture.xy) - 0.5 * spacing.zw + jitter.xy;
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

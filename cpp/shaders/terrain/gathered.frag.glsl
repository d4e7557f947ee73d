// The G-buffer of samples of pixels through which a silhouette passes.
//
// What a sample sees lies near what the pixel or a neighbour sees at its centre, so a ray is followed for a few cells
// around the nearest of those places, then around the pixel's own, then around the farthest. Where it meets nothing
// there, the sample sees the sky if one of the neighbours does, or else the plane at the pixel's centre. Where ground
// is seen at so flat an angle that a pixel spans many cells, the planes stand for it.
//
// RAMP       colours by height
// GATHERED   always set: see gathered.glsl
#include "terrain/march.glsl"

uniform sampler2D surface_texture;  // at the pixels' centres
uniform ivec2 drawn_size;
uniform float no_distance;  // infinity

// What is seen at the centres of a pixel and its neighbours: gradient and distance.
struct Around {
    vec4 own;
    vec4 nearest;
    vec4 farthest;
    ivec2 nearest_pixel;
    ivec2 farthest_pixel;
    bool sky;
};

Around look_around(ivec2 pixel) {
    vec4 own = texelFetch(surface_texture, pixel, 0);
    Around around = Around(own, own, isinf(own.z) ? vec4(-1.0) : own, pixel, pixel, isinf(own.z));
    for (int i = 0; i < 9; ++i) {
        ivec2 beside = clamp(pixel + ivec2(i % 3 - 1, i / 3 - 1), ivec2(0), drawn_size - 1);
        vec4 surface = texelFetch(surface_texture, beside, 0);
        bool sky = isinf(surface.z);
        around.sky = around.sky || sky;
        if (surface.z < around.nearest.z) {
            around.nearest = surface;
            around.nearest_pixel = beside;
        }
        if (!sky && surface.z > around.farthest.z) {
            around.farthest = surface;
            around.farthest_pixel = beside;
        }
    }
    return around;
}

// What a sample sees: gradient and distance along its ray.
struct Sight {
    bool known;
    vec2 gradient;
    float distance;
};

// The distance along a sample's ray to the plane that is seen at a pixel's centre, `apart` pixels from the sample.
float distance_to_plane(vec2 pixel, vec4 surface, vec2 apart) {
    vec3 normal = vec3(-surface.xy, 1.0);
    vec3 place = ray_origin_at(pixel + apart) + surface.z * ray_direction_at(pixel + apart);
    return dot(normal, place - ray_origin_at(pixel)) / dot(normal, ray_direction_at(pixel));
}

// Metres along the ray from one pixel to the next, on a plane.
float reach_of(vec2 pixel, vec4 surface) {
    vec3 normal = vec3(-surface.xy, 1.0);
    vec3 dx = ray_origin_dx.xyz + surface.z * ray_direction_dx.xyz;
    vec3 dy = ray_origin_dy.xyz + surface.z * ray_direction_dy.xyz;
    return (abs(dot(normal, dx)) + abs(dot(normal, dy))) / abs(dot(normal, ray_direction_at(pixel)));
}

bool is_over_terrain(vec3 relative) {
    vec2 steps = vec2(relative.x, -relative.y) / spacing.xy + base_sample_fraction.xy;
    return is_cell(base_sample.xy + ivec2(floor(steps)));
}

// Looks where the surface that is seen at a pixel's centre, `apart` pixels from the sample, would be.
Sight look(vec2 pixel, vec4 surface, vec2 apart) {
    vec3 origin = ray_origin_at(pixel);
    vec3 direction = ray_direction_at(pixel);
    float cell = max(spacing.x, spacing.y) / length(direction.xy);
    float reach = 1.5 * reach_of(pixel, surface);
    float on_plane = clamp(distance_to_plane(pixel, surface, apart), surface.z - reach, surface.z + reach);
    float from = max(min(surface.z, on_plane) - 0.25 * reach - cell, base_offset.w);
    float until = max(surface.z, on_plane) + 0.25 * reach + cell;
    float side = dot(vec3(-surface.xy, 1.0), direction) < 0.0 ? 1.0 : -1.0;
    Triangle met;
    int found = march(origin, direction, from, until, side, met);
    vec2 gradient = gradient_of(met);
    if (found == ground_met) return Sight(true, gradient, distance_along_ray(met, gradient, origin, direction));
    bool stands_for_it = found == not_known && is_over_terrain(origin + on_plane * direction);
    return Sight(stands_for_it, surface.xy, on_plane);
}

void main() {
    vec2 pixel = pixel_from_centre();
    ivec2 own_pixel = gathered_pixel();
    vec2 offset = gathered_offset();
    Around around = look_around(own_pixel);
    Sight sight = Sight(false, vec2(0.0), 0.0);
    if (!isinf(around.nearest.z))
        sight = look(pixel, around.nearest, vec2(around.nearest_pixel - own_pixel) - offset);
    if (!sight.known && !isinf(around.own.z)) sight = look(pixel, around.own, -offset);
    if (!sight.known && around.farthest.z >= 0.0)
        sight = look(pixel, around.farthest, vec2(around.farthest_pixel - own_pixel) - offset);
    if (!sight.known && around.sky) {
        out_position = uvec4(sky_block);
        out_surface = vec4(0.0, 0.0, no_distance, 1.0);
        out_base = vec4(0.0);
        return;
    }
    if (!sight.known) sight = Sight(true, around.own.xy, distance_to_plane(pixel, around.own, -offset));
    write_surface(pixel, sight.gradient, sight.distance);
}

// What the samples of each gathered pixel see, or with RAYS what sixteen rays for them do.
//
// What a sample sees lies near what the pixel or a neighbour sees at its centre. So its ray is followed for a few cells
// around the nearest of those places, then up to and around the nearest of those that lie behind, and so on. Where it
// meets nothing, the sample sees the plane at the pixel's centre; the sky if a neighbour does, or where the plane is over
// a hole. Where ground is seen at so flat an angle that a pixel spans many cells, the planes stand for it.
//
// RAMP   colours by height
// RAYS   sixteen rays a pixel
#define GATHERED 1
#include "terrain/march.glsl"

#ifndef RAYS
layout(early_fragment_tests) in;
#endif

uniform sampler2D surface_texture;  // at the pixels' centres
uniform ivec2 drawn_size;
uniform float no_distance;  // infinity

const int most_looks = 4;
// In cells, how far before a place that is seen a ray is followed: among facets smaller than a pixel, others may hide it.
#ifdef RAYS
const float cells_before = 1.0;
#else
const float cells_before = 2.0;
#endif

// As many behind what a ray passed, where ground may be seen that no centre sees.
const float most_cells_between = 6.0;

// What is seen at the centre of a pixel or a neighbour.
struct Centre {
    vec4 surface;  // as out_surface
    vec2 offset;   // of the centre, in pixels from the sample
};

// The nearest ground beyond a distance that is seen at the centre of a pixel or a neighbour; sky if there is none.
Centre nearest_beyond(float distance, ivec2 pixel, vec2 sample_offset) {
    Centre nearest = Centre(vec4(no_distance), vec2(0.0));
    for (int i = 0; i < 9; ++i) {
        ivec2 beside = clamp(pixel + ivec2(i % 3 - 1, i / 3 - 1), ivec2(0), drawn_size - 1);
        vec4 surface = texelFetch(surface_texture, beside, 0);
        if (surface.z > distance && surface.z < nearest.surface.z)
            nearest = Centre(surface, vec2(beside - pixel) - sample_offset);
    }
    return nearest;
}

bool is_beside_sky(ivec2 pixel) {
    bool sky = false;
    for (int i = 0; i < 9; ++i) {
        ivec2 beside = clamp(pixel + ivec2(i % 3 - 1, i / 3 - 1), ivec2(0), drawn_size - 1);
        sky = sky || isinf(texelFetch(surface_texture, beside, 0).z);
    }
    return sky;
}

// What a sample sees: gradient and distance along its ray; where nothing is known, how far nothing is.
struct Sight {
    bool known;
    vec2 gradient;
    float distance;
};

// The distance along a sample's ray to the plane that is seen at a pixel's centre.
float distance_to_plane(vec2 pixel, Centre centre) {
    vec3 normal = vec3(-centre.surface.xy, 1.0);
    vec2 place = pixel + centre.offset;
    vec3 seen = ray_origin_at(place) + centre.surface.z * ray_direction_at(place);
    return dot(normal, seen - ray_origin_at(pixel)) / dot(normal, ray_direction_at(pixel));
}

// Metres along the ray from one pixel to the next, on a plane.
float reach_of(vec2 pixel, vec4 surface) {
    vec3 normal = vec3(-surface.xy, 1.0);
    vec3 dx = ray_origin_dx.xyz + surface.z * ray_direction_dx.xyz;
    vec3 dy = ray_origin_dy.xyz + surface.z * ray_direction_dy.xyz;
    return (abs(dot(normal, dx)) + abs(dot(normal, dy))) / abs(dot(normal, ray_direction_at(pixel)));
}

// Whether there is ground at a place, and no hole.
bool is_over_ground(vec3 relative) {
    vec2 steps = vec2(relative.x, -relative.y) / spacing.xy + base_sample_fraction.xy;
    Cell cell = cell_of(base_sample.xy + ivec2(floor(steps)));
    vec2 place = (steps - vec2(cell.low - base_sample.xy)) / vec2(cell.high - cell.low);
    return is_cell(cell.low) && is_solid(corners_of(cell), place.y > place.x);
}

// Looks where the surface that is seen at a pixel's centre would be, and before it back to where it was looked last; if
// there is none, a few cells on from there.
Sight look(vec2 pixel, Centre centre, float last, bool first) {
    vec4 surface = centre.surface;
    vec3 origin = ray_origin_at(pixel);
    vec3 direction = ray_direction_at(pixel);
    float cell = max(spacing.x, spacing.y) / length(direction.xy);
    float reach = 1.5 * reach_of(pixel, surface);
    float on_plane = clamp(distance_to_plane(pixel, centre), surface.z - reach, surface.z + reach);
    float from = min(surface.z, on_plane) - 0.25 * reach - cells_before * cell;
    float until = max(surface.z, on_plane) + 0.25 * reach + cell;
    bool none = isinf(surface.z);
    if (!first) from = none ? last : min(from, max(last, from - most_cells_between * cell));
    if (none) until = last + most_cells_between * cell;
    bool from_below = !none && dot(vec3(-surface.xy, 1.0), direction) > 0.0;
    Triangle met;
    int found = march(origin, direction, max(from, base_offset.w), until, from_below, met);
    if (found == ground_met) {
        vec2 gradient = gradient_of(met);
        return Sight(true, gradient, distance_along_ray(met, gradient, origin, direction));
    }
    bool stands_for_it = found == not_known && !none && is_over_ground(origin + on_plane * direction);
    return Sight(stands_for_it, surface.xy, stands_for_it ? on_plane : until);
}

// The plane at the pixel's centre stands for what is not found, but beside the sky and over a hole.
Sight on_own_plane(vec2 pixel, ivec2 own_pixel, vec2 sample_offset) {
    Centre own = Centre(texelFetch(surface_texture, own_pixel, 0), -sample_offset);
    float distance = distance_to_plane(pixel, own);
    bool is_ground = is_over_ground(ray_origin_at(pixel) + distance * ray_direction_at(pixel));
    return Sight(is_ground && !is_beside_sky(own_pixel), own.surface.xy, distance);
}

void write_sky() {
    out_position = uvec4(sky_block);
    out_surface = vec4(0.0, 0.0, no_distance, 1.0);
    out_base = vec4(0.0);
}

void main() {
    vec2 pixel = pixel_from_centre();
    ivec2 own_pixel = gathered_pixel();
    vec2 sample_offset = gathered_offset();
    Sight sight = Sight(false, vec2(0.0), base_offset.w);
    int looks = 0;
    bool more;
    do {
        Centre next = nearest_beyond(sight.distance, own_pixel, sample_offset);
        more = !isinf(next.surface.z);
        sight = look(pixel, next, sight.distance, looks == 0);
        ++looks;
    } while (!sight.known && more && looks < most_looks);
    if (!sight.known) sight = on_own_plane(pixel, own_pixel, sample_offset);
    if (sight.known)
        write_surface(pixel, sight.gradient, sight.distance);
    else
        write_sky();
}

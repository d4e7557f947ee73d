// Marks pixels through whose area a silhouette or a sharp crease passes.
//
// Where one surface fills a pixel and its neighbours, the plane of its triangle says where the neighbours' rays meet
// the ground. A pixel is marked where that is too far from where they do, counted in the pixel's own footprints, or
// where one of them sees the sky.
//
//         \ |  |          plane of p says: q's ray meets the ground here   x
//          \p  q          but it does there                                    o
//           \|  |                                                          |<->|
#include "shared/ray.glsl"

layout(location = 0) out float mark;

uniform sampler2D surface_texture;
uniform ivec2 drawn_size;

const float farthest = 1.0;  // footprints

const ivec2 neighbours[4] = ivec2[](ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1));

// How far on the map, in footprints, what is seen beside a pixel is from the pixel's plane.
float distance_from_plane(vec4 surface, mat2 footprints_of_map, vec4 beside, vec2 pixel, vec2 step) {
    vec3 normal = vec3(-surface.xy, 1.0);
    vec3 direction = ray_direction_at(pixel + step);
    vec3 place = ray_origin_at(pixel) + surface.z * ray_direction_at(pixel);
    float expected = dot(normal, place - ray_origin_at(pixel + step)) / dot(normal, direction);
    return length(footprints_of_map * (direction.xy * (beside.z - expected)));
}

#ifdef OVERLAY
uniform sampler2D overlay_texture;
uniform float farthest_at_borders;  // footprints

// Whether a border of a feature may pass through the pixel: a neighbour shows another colour.
bool is_at_border(ivec2 pixel) {
    vec4 color = texelFetch(overlay_texture, pixel, 0);
    vec4 apart = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 neighbour = clamp(pixel + neighbours[i], ivec2(0), drawn_size - 1);
        apart = max(apart, abs(texelFetch(overlay_texture, neighbour, 0) - color));
    }
    return any(greaterThan(apart, vec4(0.01)));
}
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec2 place = pixel_from_centre();
    vec4 surface = texelFetch(surface_texture, pixel, 0);
    bool sky = isinf(surface.z);
    mat2 footprints_of_map = sky ? mat2(0.0) : inverse(footprint(place, surface.xy, surface.z));
    float most = farthest;
#ifdef OVERLAY
    if (is_at_border(pixel)) most = farthest_at_borders;
#endif
    bool marked = false;
    for (int i = 0; i < 4; ++i) {
        ivec2 neighbour = clamp(pixel + neighbours[i], ivec2(0), drawn_size - 1);
        vec4 beside = texelFetch(surface_texture, neighbour, 0);
        vec2 step = vec2(neighbour - pixel);
        bool near = distance_from_plane(surface, footprints_of_map, beside, place, step) <= most;
        marked = marked || isinf(beside.z) != sky || (!sky && !near);
    }
    mark = float(marked);
}

// Marks pixels through whose area a silhouette passes, with 1, or a crease, with 0.5.
//
// Where one surface fills a pixel and its neighbours, the plane of its triangle says where the neighbours' rays meet
// the ground. A pixel is marked where that is too far from where they do, counted in the pixel's own footprints, or
// where one of them sees the sky. At a border of a feature less is enough, and least where facets are about as small as
// pixels: what is seen beside may be near the plane by chance.
//
//         \ |  |          plane of p says: q's ray meets the ground here   x
//          \p  q          but it does there                                    o
//           \|  |                                                          |<->|
#include "shared/ray.glsl"

layout(location = 0) out float mark;

uniform sampler2D surface_texture;
uniform ivec2 drawn_size;

const float farthest = 1.0;  // footprints
// The longer side of a pixel, in cells of the terrain, from which on facets are small.
const float smallest_facets = 0.8;
const float farthest_among_small = 0.08;  // footprints

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

uniform usampler2D tile_levels;  // of detail, as drawn

// Metres that the triangles at a pixel are long on the map.
float cell_at(vec2 place, float distance) {
    vec2 relative = (ray_origin_at(place) + distance * ray_direction_at(place)).xy;
    ivec2 first = base_sample.xy + ivec2(floor(vec2(relative.x, -relative.y) / spacing.xy + base_sample_fraction.xy));
    first = clamp(first, ivec2(0), samples.xy - 1);
    const int tile_quads = 64;
    return max(spacing.x, spacing.y) * float(1 << texelFetch(tile_levels, first / tile_quads, 0).r);
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
    bool at_border = is_at_border(pixel);
    if (at_border) most = farthest_at_borders;
    float distance = sky ? 0.0 : surface.z;
    mat2 foot = footprint(place, surface.xy, distance);
    bool is_small = max(length(foot[0]), length(foot[1])) > smallest_facets * cell_at(place, distance);
    if (at_border && is_small) most = min(most, farthest_among_small);
#endif
    bool marked = false, is_silhouette = false;
    for (int i = 0; i < 4; ++i) {
        ivec2 neighbour = clamp(pixel + neighbours[i], ivec2(0), drawn_size - 1);
        vec4 beside = texelFetch(surface_texture, neighbour, 0);
        vec2 step = vec2(neighbour - pixel);
        float apart = distance_from_plane(surface, footprints_of_map, beside, place, step);
        bool at_sky = isinf(beside.z) != sky;
        is_silhouette = is_silhouette || at_sky || (!sky && !(apart <= farthest));
        marked = marked || at_sky || (!sky && !(apart <= most));
    }
    mark = is_silhouette ? 1.0 : marked ? 0.5 : 0.0;
}

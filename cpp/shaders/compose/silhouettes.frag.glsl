// Marks pixels through whose area a silhouette passes, with 1, or a crease, with 0.5.
//
// Where one surface fills a pixel and its neighbours, the plane of its triangle says where the neighbours' rays meet
// the ground. A pixel is marked where that is too far from where they do, counted in the pixel's own footprints, or
// where one of them sees the sky. At a border of a feature less is enough, and least where facets are about as small as
// pixels: what is seen beside may be near the plane by chance. A hole may lie between the centres: a pixel is marked too
// where the ground at one of its corners has a missing sample.
//
//         \ |  |          plane of p says: q's ray meets the ground here   x
//          \p  q          but it does there                                    o
//           \|  |                                                          |<->|
//
// OVERLAY  with layers
// HOLES    the terrain has missing samples
// SLOPES   strokes are as wide as the ground is steep: then a border bends at every crease, also where the plane goes on as
//          nearly as from above
#include "shared/ray.glsl"
#include "terrain/mesh.glsl"

layout(location = 0) out float mark;

uniform sampler2D surface_texture;
uniform ivec2 drawn_size;

const float farthest = 1.0;  // footprints
// The longer side of a pixel, in cells of the terrain, from which on facets are small.
const float smallest_facets = 0.8;
const float farthest_among_small = 0.08;  // footprints

// Between the gradients of neighbours at a border, from which on widths that follow slopes bend.
const float most_between_slopes = 1e-3;

const ivec2 neighbours[4] = ivec2[](ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1));

// How far on the map, in footprints, what is seen beside a pixel is from the pixel's plane.
float distance_from_plane(vec4 surface, mat2 footprints_of_map, vec4 beside, vec2 pixel, vec2 step) {
    vec3 normal = vec3(-surface.xy, 1.0);
    vec3 direction = ray_direction_at(pixel + step);
    vec3 place = ray_origin_at(pixel) + surface.z * ray_direction_at(pixel);
    float expected = dot(normal, place - ray_origin_at(pixel + step)) / dot(normal, direction);
    return length(footprints_of_map * (direction.xy * (beside.z - expected)));
}

// The sample to the north west of what is seen at a distance.
ivec2 sample_at(vec2 place, float distance, vec2 offset) {
    vec2 relative = (ray_origin_at(place) + distance * ray_direction_at(place)).xy + offset;
    return base_sample.xy + ivec2(floor(vec2(relative.x, -relative.y) / spacing.xy + base_sample_fraction.xy));
}

#ifdef HOLES
bool is_at_hole(vec2 place, float distance, mat2 foot) {
    bool missing = false;
    for (int i = 0; i < 4; ++i) {
        vec2 corner = vec2(i & 1, i >> 1) - 0.5;
        ivec2 first = sample_at(place, distance, foot * corner);
        vec4 around = textureGather(heights, (vec2(first) + 1.0) / vec2(samples.xy));
        missing = missing || any(lessThan(around, vec4(missing_height)));
    }
    return missing;
}
#endif

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
    ivec2 first = clamp(sample_at(place, distance, vec2(0.0)), ivec2(0), samples.xy - 1);
    return max(spacing.x, spacing.y) * float(1 << texelFetch(tile_levels, first / tile_quads, 0).r);
}
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec2 place = pixel_from_centre();
    vec4 surface = texelFetch(surface_texture, pixel, 0);
    bool sky = isinf(surface.z);
    float distance = sky ? 0.0 : surface.z;
    mat2 foot = footprint(place, surface.xy, distance);
    mat2 footprints_of_map = sky ? mat2(0.0) : inverse(foot);
    float most = farthest;
    bool at_border = false;
#ifdef OVERLAY
    at_border = is_at_border(pixel);
    if (at_border) most = farthest_at_borders;
    bool is_small = max(length(foot[0]), length(foot[1])) > smallest_facets * cell_at(place, distance);
    if (at_border && is_small) most = min(most, farthest_among_small);
#endif
    bool is_silhouette = false;
#ifdef HOLES
    is_silhouette = !sky && is_at_hole(place, distance, foot);
#endif
    bool marked = is_silhouette;
    for (int i = 0; i < 4; ++i) {
        ivec2 neighbour = clamp(pixel + neighbours[i], ivec2(0), drawn_size - 1);
        vec4 beside = texelFetch(surface_texture, neighbour, 0);
        vec2 step = vec2(neighbour - pixel);
        float apart = distance_from_plane(surface, footprints_of_map, beside, place, step);
        bool at_sky = isinf(beside.z) != sky;
        is_silhouette = is_silhouette || at_sky || (!sky && !(apart <= farthest));
        marked = marked || at_sky || (!sky && !(apart <= most));
#ifdef SLOPES
        marked = marked || (at_border && length(beside.xy - surface.xy) > most_between_slopes);
#endif
    }
    mark = is_silhouette ? 1.0 : marked ? 0.5 : 0.0;
}

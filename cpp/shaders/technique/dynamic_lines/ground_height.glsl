// The ground under a place of the map, relative to the view's base: the triangles of terrain/mesh.glsl in full detail.
// Beyond the outer samples it goes on level.
#include "shared/view_block.h"

uniform sampler2D ground_samples;

const float missing_ground = -1e30;  // below: none

float ground_sample(ivec2 at) {
    return texelFetch(ground_samples, at, 0).r;
}

float ground_height(vec2 place) {
    vec2 at = vec2(place.x, -place.y) / spacing.xy + base_sample_fraction.xy;
    ivec2 cell = ivec2(floor(at)) + base_sample.xy, last = samples.xy - 2;
    vec2 inside = at - floor(at);
    inside = mix(inside, vec2(0.0), lessThan(cell, ivec2(0)));
    inside = mix(inside, vec2(1.0), greaterThan(cell, last));
    cell = clamp(cell, ivec2(0), last);
    float north_west = ground_sample(cell), south_east = ground_sample(cell + 1);
    bool south = inside.y > inside.x;
    float third = ground_sample(cell + (south ? ivec2(0, 1) : ivec2(1, 0)));
    if (min(min(north_west, south_east), third) < missing_ground) return 2.0 * missing_ground;
    vec2 slope = south ? vec2(south_east - third, third - north_west) : vec2(third - north_west, south_east - third);
    return north_west + dot(slope, inside) - base_sample_fraction.z - base_sample_fraction.w;
}

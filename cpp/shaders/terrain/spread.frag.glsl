// The G-buffer of the samples of gathered pixels: each on the plane that the ray of its sixteenth of the pixel met.
//
//     texel of a ray        four samples
//          +---+              +-+-+
//          | r |              |s|s|      those of the pixel's 64 that lie in the same sixteenth as r
//          +---+              +-+-+
//                             |s|s|
//                             +-+-+
//
// Depth is 1 where samples need rays of their own.
#define GATHERED 1
#include "terrain/surface.glsl"

uniform usampler2D ray_position_texture;
uniform sampler2D ray_surface_texture;
uniform sampler2D ray_base_texture;
uniform sampler2D facets_texture;  // a texel a pixel
uniform vec2 ray_offsets[16];  // as gathered_offsets, of the rays

// By more than what float32 rounds.
bool is_over_terrain(vec2 relative) {
    vec2 steps = vec2(relative.x, -relative.y) / spacing.xy + base_sample_fraction.xy;
    vec2 cell = vec2(base_sample.xy) + steps;
    const float margin = 1e-3;
    return all(greaterThan(cell, vec2(margin))) && all(lessThan(cell, vec2(samples.xy - 1) - margin));
}

void main() {
    ivec2 ray = ivec2(gl_FragCoord.xy) / 2;
    gl_FragDepth = texelFetch(facets_texture, ray / 4, 0).r;
    vec4 surface = texelFetch(ray_surface_texture, ray, 0);
    out_base = texelFetch(ray_base_texture, ray, 0);
    out_position = texelFetch(ray_position_texture, ray, 0);
    out_surface = surface;
    if (!isinf(surface.z)) {
        vec2 apart = gathered_offset() - ray_offsets[(ray.y & 3) * 4 + (ray.x & 3)];
        vec2 place = pixel_from_centre() - apart;
        vec2 step = footprint(place, surface.xy, surface.z) * apart;
        // Seen edge-on, a plane soon leaves its triangle behind, and at the rim the terrain: there the samples see
        // what the ray does.
        vec3 direction = ray_direction_at(place);
        float along = abs(dot(vec3(-surface.xy, 1.0), direction));
        bool is_edge_on = along < edge_on * length(vec3(surface.xy, 1.0)) * length(direction);
        vec3 met = ray_origin_at(place) + surface.z * direction;
        bool leaves = is_edge_on && length(step) > max(spacing.x, spacing.y);
        if (leaves || !is_over_terrain(met.xy + step)) step = vec2(0.0);
        vec3 relative = met + vec3(step, dot(surface.xy, step));
        out_position = pack_position(map_position(relative));
        out_surface.z = dot(relative, forward.xyz);
    }
}

// What the G-buffer holds of a place on the terrain, and where a ray meets the plane of a triangle.
//
// RAMP   colours by height
#include "terrain/mesh.glsl"
#include "shared/position.glsl"
#include "shared/ray.glsl"

layout(location = 0) out uvec4 out_position;
layout(location = 1) out vec4 out_surface;  // gradient x, y; distance along the ray; hillshade
layout(location = 2) out vec4 out_base;

uniform sampler2D illumination;
uniform vec3 hillshade;  // cosine on level ground; strength
uniform vec3 base_color;
#ifdef RAMP
uniform sampler2D ramp;
uniform vec2 ramp_range;
#endif

const float edge_on = 0.1;  // sine of the angle between ray and plane

struct Triangle {
    vec3 a;
    vec3 b;
    vec3 c;
};

vec2 gradient_of(Triangle t) {
    vec3 u = t.b - t.a;
    vec3 v = t.c - t.a;
    return vec2(u.z * v.y - v.z * u.y, v.z * u.x - u.z * v.x) / (u.x * v.y - u.y * v.x);
}

// Narrows a range of distances along a ray, seen on the map, to the inner side of a triangle's edge.
vec2 inside_edge(vec2 range, vec2 from, vec2 to, vec2 origin, vec2 direction) {
    vec2 along = to - from;
    vec2 apart = origin - from;
    float start = along.x * apart.y - along.y * apart.x;
    float step = along.x * direction.y - along.y * direction.x;
    if (step > 0.0) range.x = max(range.x, -start / step);
    if (step < 0.0) range.y = min(range.y, -start / step);
    return range;
}

float distance_along_ray(Triangle t, vec2 gradient, vec3 origin, vec3 direction) {
    vec3 normal = vec3(-gradient, 1.0);
    vec3 depths = vec3(dot(t.a, forward.xyz), dot(t.b, forward.xyz), dot(t.c, forward.xyz));
    vec2 range = vec2(min(depths.x, min(depths.y, depths.z)), max(depths.x, max(depths.y, depths.z)));
    range = max(range, base_offset.w);
    float along = dot(normal, direction);
    if (abs(along) < edge_on * length(normal) * length(direction)) {
        vec2 over = inside_edge(range, t.a.xy, t.b.xy, origin.xy, direction.xy);
        over = inside_edge(over, t.b.xy, t.c.xy, origin.xy, direction.xy);
        over = inside_edge(over, t.c.xy, t.a.xy, origin.xy, direction.xy);
        if (over.x <= over.y) range = over;
        if (along == 0.0) return range.x;
    }
    return clamp(dot(normal, t.a - origin) / along, range.x, range.y);
}

Position map_position(vec3 relative) {
    vec2 local = base_offset.xy + relative.xy;
    vec2 blocks = floor(local / base_offset.z);
    return Position(base_block.xy + ivec2(blocks), local - blocks * base_offset.z);
}

float shade_at(vec3 relative, mat2 foot) {
    vec2 steps = vec2(relative.x, -relative.y) / spacing.xy + base_sample_fraction.xy;
    vec2 coordinates = (vec2(base_sample.xy) + steps + 0.5) / vec2(samples.xy);
    vec2 scale = vec2(1.0, -1.0) / (spacing.xy * vec2(samples.xy));
    float cosine = textureGrad(illumination, coordinates, foot[0] * scale, foot[1] * scale).r;
    return 1.0 + hillshade.y * (cosine - hillshade.x) / max(hillshade.x, 0.05);
}

void write_surface(vec2 pixel, vec2 gradient, float distance) {
    vec3 relative = ray_origin_at(pixel) + distance * ray_direction_at(pixel);
    out_position = pack_position(map_position(relative));
    out_surface = vec4(gradient, distance, shade_at(relative, footprint(pixel, gradient, distance)));
#ifdef RAMP
    float height = relative.z + base_sample_fraction.z;
    out_base = vec4(textureLod(ramp, vec2((height - ramp_range.x) / (ramp_range.y - ramp_range.x), 0.5), 0.0).rgb, 1.0);
#else
    out_base = vec4(base_color, 1.0);
#endif
}

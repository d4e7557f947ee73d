// Corners of volumes: a place on the lattice, and the height of its lid or its bottom.
//
// The terrain is drawn with levels of detail, so it may lie outside of the heights of its samples, by pixels. Lids and
// bottoms keep away from it by as much, and so far that depth tells them apart.
#include "shared/view_block.h"

uniform isamplerBuffer volume_vertices;  // place x, y; lowest | highest << 16, in steps
uniform ivec2 base_place;                // the base on the lattice, and metres past it
uniform vec2 base_past;
uniform float quantum;
uniform vec2 height_steps;    // the lowest ground, and metres of a step
uniform float terrain_error;  // pixels

const float pixels_apart = 0.25;
const float depth_digits = 1e-6;
const float height_digits = 3e-7;

// Metres that a pixel is wide at a point, up to a quarter behind the eye.
float pixel_width(vec3 point) {
    float along = dot(forward.xyz, point);
    return length(ray_origin_dy.xyz + along * ray_direction_dy.xyz);
}

void main() {
    ivec3 vertex = texelFetch(volume_vertices, gl_VertexID >> 1).xyz;
    bool is_lid = (gl_VertexID & 1) == 1;
    // The integer difference comes first: it is exact.
    vec2 place = vec2(vertex.xy - base_place) * quantum - base_past;
    vec2 heights = height_steps.x + height_steps.y * vec2(vertex.z & 0xFFFF, (vertex.z >> 16) & 0xFFFF);
    vec2 relative = (heights - base_sample_fraction.z) - base_sample_fraction.w;
    // Distances change evenly over a face, so what is far enough at its corners is so all over it.
    float pixel = max(pixel_width(vec3(place, relative.x)), pixel_width(vec3(place, relative.y)));
    float depth = max(abs(forward.w + dot(forward.xyz, vec3(place, relative.x))),
                      abs(forward.w + dot(forward.xyz, vec3(place, relative.y))));
    float apart = (2.0 * terrain_error + pixels_apart) * pixel + depth_digits * depth +
                  height_digits * max(abs(heights.x), abs(heights.y));
    vec4 clip = clip_from_base * vec4(place, is_lid ? relative.y + apart : relative.x - apart, 1.0);
    // As terrain.vert.glsl does, so that a picture may be cut into rectangles.
    clip.xy -= 2.0 * jitter.xy / spacing.zw * clip.w;
    if (clip.w > 0.0) {
        vec2 steps = 128.0 * spacing.zw;
        clip.xy = round(clip.xy / clip.w * steps) / steps * clip.w;
    }
    gl_Position = clip;
}

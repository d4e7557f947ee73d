// Vertices of lines with offsets to the left and to the right, in half widths (Taibo et al. 2014, solution 4b).
//
// POLAR     the offsets are radius and angle
#include "technique/clipmap/tile_vertex.glsl"

layout(location = 2) in vec4 offsets;
out vec4 vertex_color;
out vec4 vertex_offsets;

void main() {
    gl_Position = vec4(clip_place(), 0.0, 1.0);
    vertex_color = decal_color();
#ifdef POLAR
    vertex_offsets = vec4(offsets.x * vec2(cos(offsets.y), sin(offsets.y)), offsets.z * vec2(cos(offsets.w), sin(offsets.w)));
#else
    vertex_offsets = offsets;
#endif
}

// Vertices of lines that a geometry shader tessellates (Taibo et al. 2014, solution 4a).
#include "technique/clipmap/tile_vertex.glsl"

out vec4 vertex_color;

void main() {
    gl_Position = vec4(clip_place(), 0.0, 1.0);
    vertex_color = decal_color();
}

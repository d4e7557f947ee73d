// Triangles and line primitives, as they are.
#include "technique/clipmap/tile_vertex.glsl"

flat out vec4 color;

void main() {
    gl_Position = vec4(clip_place(), 0.0, 1.0);
    color = decal_color();
}

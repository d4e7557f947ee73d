// A segment is one point; the geometry shader makes it a box.
layout(location = 0) in uvec4 segment;
layout(location = 1) in uvec2 rest;

flat out uvec4 point_segment;
flat out uvec2 point_rest;

void main() {
    point_segment = segment;
    point_rest = rest;
    gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
}

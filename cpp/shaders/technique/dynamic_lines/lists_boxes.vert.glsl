// A point for each segment; the geometry shader makes its box.
flat out int segment_index;

void main() {
    segment_index = gl_VertexID;
}

// A quad for each segment, from offsets that were worked out before (Taibo et al. 2014, solution 4b).
layout(lines) in;
layout(triangle_strip, max_vertices = 4) out;

in vec4 vertex_color[];
in vec4 vertex_offsets[];
flat out vec4 color;

uniform float clip_per_half_width;

void emit_pair(int i) {
    vec4 offsets = vertex_offsets[i] * clip_per_half_width;
    color = vertex_color[0];
    gl_Position = vec4(gl_in[i].gl_Position.xy + offsets.xy, 0.0, 1.0);
    EmitVertex();
    color = vertex_color[0];
    gl_Position = vec4(gl_in[i].gl_Position.xy + offsets.zw, 0.0, 1.0);
    EmitVertex();
}

void main() {
    emit_pair(0);
    emit_pair(1);
    EndPrimitive();
}

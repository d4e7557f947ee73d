// A strip for each segment, with its joints (Taibo et al. 2014, solution 4a): line_strips.cpp in a shader.
//
// Of a joint between two segments, the second one begins with its last pair of corners, and the first one ends with all.
layout(lines_adjacency) in;
layout(triangle_strip, max_vertices = 6) out;

in vec4 vertex_color[];
flat out vec4 color;

uniform float clip_per_half_width;
uniform float bevel_cosine;  // of directions: below it a joint is bevelled
uniform bool inner_meets;    // method 3b

const float collinear = 1e-6;

struct Pairs {
    vec4 first;  // left and right corner, in half widths from the vertex
    vec4 last;
    bool are_two;
};

vec2 to_the_left(vec2 d) {
    return vec2(-d.y, d.x);
}

Pairs across(vec2 d) {
    vec4 pair = vec4(to_the_left(d), -to_the_left(d));
    return Pairs(pair, pair, false);
}

// `shorter` of the two segments, in half widths.
Pairs joint(vec2 coming, vec2 going, float shorter) {
    float turn = coming.x * going.y - coming.y * going.x;
    float cosine = dot(coming, going);
    vec2 before = to_the_left(coming);
    vec2 after = to_the_left(going);
    if (abs(turn) < collinear && cosine > 0.0) return across(going);
    vec2 meeting = (before + after) / (1.0 + cosine);
    vec4 both = vec4(meeting, -meeting);
    if (cosine >= bevel_cosine) return Pairs(both, both, false);
    float reach = abs(turn) / max(1.0 + cosine, 1e-6);
    if (!inner_meets || reach > shorter) return Pairs(vec4(before, -before), vec4(after, -after), true);
    if (turn > 0.0) return Pairs(vec4(meeting, -before), vec4(meeting, -after), true);
    return Pairs(vec4(before, -meeting), vec4(after, -meeting), true);
}

void emit_pair(vec2 at, vec4 pair) {
    color = vertex_color[1];
    gl_Position = vec4(at + clip_per_half_width * pair.xy, 0.0, 1.0);
    EmitVertex();
    color = vertex_color[1];
    gl_Position = vec4(at + clip_per_half_width * pair.zw, 0.0, 1.0);
    EmitVertex();
}

void main() {
    vec2 a = gl_in[0].gl_Position.xy, b = gl_in[1].gl_Position.xy;
    vec2 c = gl_in[2].gl_Position.xy, d = gl_in[3].gl_Position.xy;
    float own = length(c - b);
    if (own > 0.0) {
        vec2 along = (c - b) / own;
        Pairs begin = across(along);
        Pairs end = begin;
        if (a != b) begin = joint(normalize(b - a), along, min(own, length(b - a)) / clip_per_half_width);
        if (c != d) end = joint(along, normalize(d - c), min(own, length(d - c)) / clip_per_half_width);
        emit_pair(b, begin.last);
        emit_pair(c, end.first);
        if (end.are_two) emit_pair(c, end.last);
        EndPrimitive();
    }
}

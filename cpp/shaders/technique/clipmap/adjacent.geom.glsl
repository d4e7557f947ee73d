// A strip for each segment, with its joints (Taibo et al. 2014, solution 4a): line_strips.cpp in a shader.
//
// Of a joint between two segments, the second one begins with its last pair of corners, and the first one ends with all.
layout(lines_adjacency) in;
layout(triangle_strip, max_vertices = 10) out;

in vec4 vertex_color[];
flat out vec4 color;

uniform float clip_per_half_width;
uniform float bevel_cosine;  // of directions: below it a joint is bevelled
uniform bool inner_meets;    // method 3b
uniform bool has_joints;     // else method 1

const float collinear = 1e-6;

struct Pairs {
    vec4 first;  // left and right corner, in half widths from the vertex
    vec4 second;
    vec4 third;
    vec4 last;
    int count;  // 2: the first and the last
};

vec2 to_the_left(vec2 d) {
    return vec2(-d.y, d.x);
}

Pairs one(vec4 pair) {
    return Pairs(pair, pair, pair, pair, 1);
}

Pairs two(vec4 first, vec4 last) {
    return Pairs(first, first, last, last, 2);
}

Pairs across(vec2 d) {
    return one(vec4(to_the_left(d), -to_the_left(d)));
}

// `shorter` of the two segments, in half widths.
Pairs joint(vec2 coming, vec2 going, float shorter) {
    float turn = coming.x * going.y - coming.y * going.x;
    float cosine = dot(coming, going);
    vec2 before = to_the_left(coming);
    vec2 after = to_the_left(going);
    if (abs(turn) < collinear && cosine > 0.0) return across(going);
    vec2 meeting = (before + after) / (1.0 + cosine);
    bool meets = inner_meets && abs(turn) / max(1.0 + cosine, 1e-6) <= shorter;
    bool is_left = turn > 0.0;
    if (cosine < bevel_cosine) {
        vec4 inner = meets ? vec4(meeting, meeting) : vec4(before, after);
        if (is_left) return two(vec4(inner.xy, -before), vec4(inner.zw, -after));
        return two(vec4(before, -inner.xy), vec4(after, -inner.zw));
    }
    if (meets || !inner_meets) return one(vec4(meeting, -meeting));
    vec4 second = is_left ? vec4(vec2(0.0), -meeting) : vec4(before, vec2(0.0));
    vec4 third = is_left ? vec4(-after, -after) : vec4(meeting, after);
    return Pairs(vec4(before, -before), second, third, vec4(after, -after), 4);
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
        if (a != b && has_joints) begin = joint(normalize(b - a), along, min(own, length(b - a)) / clip_per_half_width);
        if (c != d && has_joints) end = joint(along, normalize(d - c), min(own, length(d - c)) / clip_per_half_width);
        emit_pair(b, begin.last);
        emit_pair(c, end.first);
        if (end.count == 4) {
            emit_pair(c, end.second);
            emit_pair(c, end.third);
        }
        if (end.count > 1) emit_pair(c, end.last);
        EndPrimitive();
    }
}

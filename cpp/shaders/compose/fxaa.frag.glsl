// FXAA: smooths the edges that the composed picture shows, whatever they come from.
//
// T. Lottes: FXAA, NVIDIA white paper, 2009, in the form of version 3.11 (2011). Where the contrast with the four
// neighbours is high, the edge's direction is found from the 3 x 3 pixels around; the edge is followed both ways to
// where it ends; and from how near the nearer end is follows how far the neighbour across the edge reaches in.
//
//     . . . . # #     #: the brighter side. The pixel p lies on an edge that ends on the left, where the brightness
//     # # p # # #     of the pairs across it changes: so p takes some of the pixel above it, less the farther it is
//     <---|----->     from that end.
//
// Every pixel is read by itself and never between pixels, so that a picture drawn in rectangles has the same bytes.
layout(location = 0) out vec4 color;

uniform sampler2D composed_texture;  // straight alpha
uniform ivec2 drawn_size;

const float least_contrast = 0.0312;   // what dark places need to be an edge
const float contrast_share = 0.125;    // of the brightest pixel around: what bright places need
const float end_share = 0.25;          // of the gradient across: where the edge ends
const float single_pixel_share = 0.75; // how much single bright or dark pixels are blurred
const int search_steps = 16;           // along the edge; frame/pipeline.cpp draws as many pixels around a rectangle

vec4 pixel_at(ivec2 pixel) {
    vec4 straight = texelFetch(composed_texture, clamp(pixel, ivec2(0), drawn_size - 1), 0);
    return vec4(straight.rgb * straight.a, straight.a);
}

float brightness_at(ivec2 pixel) {
    return dot(pixel_at(pixel).rgb, vec3(0.299, 0.587, 0.114));
}

// The brightness of a pixel (column 1, row 1) and its neighbours, [column][row].
mat3 around(ivec2 pixel) {
    mat3 result;
    for (int x = 0; x < 3; ++x)
        for (int y = 0; y < 3; ++y)
            result[x][y] = brightness_at(pixel + ivec2(x - 1, y - 1));
    return result;
}

struct Edge {
    ivec2 along;
    ivec2 across;    // to the neighbour on its other side
    float middle;    // brightness of the edge here: the mean of both sides
    float gradient;  // across
};

// How much brightness bends across the columns of m: an edge that runs along the rows has it high.
float bend(mat3 m) {
    vec3 bends = vec3(m[0][0] + m[2][0] - 2.0 * m[1][0], m[0][1] + m[2][1] - 2.0 * m[1][1],
                      m[0][2] + m[2][2] - 2.0 * m[1][2]);
    return dot(abs(bends), vec3(1.0, 2.0, 1.0));
}

Edge edge_through(mat3 m) {
    bool upright = bend(m) >= bend(transpose(m));
    float before = upright ? m[0][1] : m[1][0];
    float after = upright ? m[2][1] : m[1][2];
    bool first = abs(before - m[1][1]) >= abs(after - m[1][1]);
    ivec2 across = (upright ? ivec2(1, 0) : ivec2(0, 1)) * (first ? -1 : 1);
    float beside = first ? before : after;
    return Edge(upright ? ivec2(0, 1) : ivec2(1, 0), across, 0.5 * (beside + m[1][1]), abs(beside - m[1][1]));
}

// Steps to the end of the edge in one direction, and how its brightness differs there.
vec2 end_of(ivec2 pixel, Edge edge, ivec2 step, bool wanted) {
    int steps = 0;
    float difference = 0.0;
    bool ended = !wanted;
    do {
        ++steps;
        ivec2 place = pixel + steps * step;
        difference = 0.5 * (brightness_at(place) + brightness_at(place + edge.across)) - edge.middle;
        ended = ended || abs(difference) >= end_share * edge.gradient;
    } while (!ended && steps < search_steps);
    return vec2(float(steps), difference);
}

// The share of the neighbour across an edge in this pixel.
float share_along_edge(ivec2 pixel, float own, Edge edge, bool wanted) {
    vec2 back = end_of(pixel, edge, -edge.along, wanted);
    vec2 on = end_of(pixel, edge, edge.along, wanted);
    vec2 nearer = back.x < on.x ? back : on;
    // The pixel is on the side that gives way only where the end leans to the other side.
    bool gives_way = (own < edge.middle) != (nearer.y < 0.0);
    return gives_way ? 0.5 - nearer.x / (back.x + on.x) : 0.0;
}

// The same for a pixel that differs from all around it.
float share_of_single_pixel(mat3 m, float contrast) {
    float sides = m[0][1] + m[2][1] + m[1][0] + m[1][2];
    float corners = m[0][0] + m[2][0] + m[0][2] + m[2][2];
    float difference = abs((2.0 * sides + corners) / 12.0 - m[1][1]);
    float amount = smoothstep(0.0, 1.0, clamp(difference / max(contrast, 1e-6), 0.0, 1.0));
    return single_pixel_share * amount * amount;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    mat3 m = around(pixel);
    float brightest = max(m[1][1], max(max(m[0][1], m[2][1]), max(m[1][0], m[1][2])));
    float darkest = min(m[1][1], min(min(m[0][1], m[2][1]), min(m[1][0], m[1][2])));
    float contrast = brightest - darkest;
    bool on_edge = contrast >= max(least_contrast, contrast_share * brightest);
    Edge edge = edge_through(m);
    float share = max(share_along_edge(pixel, m[1][1], edge, on_edge), share_of_single_pixel(m, contrast));
    vec4 own = texelFetch(composed_texture, pixel, 0);
    vec4 mixed = mix(pixel_at(pixel), pixel_at(pixel + edge.across), share);
    vec4 straight = mixed.a > 0.0 ? vec4(mixed.rgb / mixed.a, mixed.a) : vec4(0.0);
    color = on_edge ? straight : own;
}

// Adds the picture of one sample to that of all, and copies those to where they belong.
uniform sampler2D samples;
uniform int first_row;  // of the strip that they are
uniform float share;    // that each has

layout(location = 0) out vec4 color;

void main() {
    color = share * texelFetch(samples, ivec2(gl_FragCoord.xy) - ivec2(0, first_row), 0);
}

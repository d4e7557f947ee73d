// The mean of a picture's samples, from their premultiplied sum to straight alpha.
layout(location = 0) out vec4 color;

uniform sampler2D sum_texture;
uniform float sample_count;

void main() {
    vec4 sum = texelFetch(sum_texture, ivec2(gl_FragCoord.xy), 0);
    color = sum.a > 0.0 ? vec4(sum.rgb / sum.a, sum.a / sample_count) : vec4(0.0);
}

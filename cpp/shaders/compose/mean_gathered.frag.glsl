// The mean of the samples of each pixel that was gathered, from premultiplied to straight alpha.
#include "shared/gathered.glsl"

layout(location = 0) out vec4 color;

uniform sampler2D composed_texture;

void main() {
    ivec2 corner = gathered_side * ivec2(gl_FragCoord.xy);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < gathered_samples; ++i)
        sum += texelFetch(composed_texture, corner + ivec2(i % gathered_side, i / gathered_side), 0);
    color = sum.a > 0.0 ? vec4(sum.rgb / sum.a, sum.a / float(gathered_samples)) : vec4(0.0);
}

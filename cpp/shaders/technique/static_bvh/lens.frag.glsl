// What is seen inside the lens in place of what is seen outside, by each pixel's share.
#include "technique/static_bvh/lens_share.glsl"

uniform sampler2D inside;

layout(location = 0, index = 0) out vec4 color;
layout(location = 0, index = 1) out vec4 share;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    share = vec4(lens_share(pixel));
    if (share.a == 0.0) discard;
    color = share.a * texelFetch(inside, pixel, 0);
}

// The floor that overlay passes are measured against: read the depth, write a colour, do nothing else.
layout(location = 0) out vec4 color;

uniform sampler2D depth_texture;

void main() {
    color = vec4(texelFetch(depth_texture, ivec2(gl_FragCoord.xy), 0).r);
}

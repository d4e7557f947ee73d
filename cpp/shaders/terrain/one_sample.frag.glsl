// One sample of each pixel of a multisampled G-buffer, as a G-buffer that techniques can read.
layout(location = 0) out uvec4 out_position;
layout(location = 1) out vec4 out_surface;  // as terrain.frag.glsl
layout(location = 2) out vec4 out_base;

uniform usampler2DMS position_texture;
uniform sampler2DMS surface_texture;
uniform sampler2DMS base_texture;
uniform int sample_index;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    out_position = texelFetch(position_texture, pixel, sample_index);
    out_surface = texelFetch(surface_texture, pixel, sample_index);
    out_base = texelFetch(base_texture, pixel, sample_index);
}

// The picture: the overlay over the shaded terrain, or the sky. "Over" on sRGB values, as map tools do.
//
// OVERLAY   a layer was drawn
// SAMPLE    one of the samples of a picture: premultiplied, to be added up
// GATHERED  samples of pixels from anywhere in the picture
#include "shared/ray.glsl"

layout(location = 0) out vec4 color;

uniform sampler2D surface_texture;
uniform sampler2D base_texture;
#ifdef OVERLAY
uniform sampler2D overlay_texture;
#endif
uniform float layer_shading;
uniform vec4 sky_low;   // straight alpha; at the horizon
uniform vec4 sky_high;  // 45 degrees above it

vec4 sky() {
    vec3 direction = ray_direction_at(pixel_from_centre());
    float rise = clamp(direction.z / max(length(direction.xy), 1e-6), 0.0, 1.0);
    return mix(sky_low, sky_high, rise);
}

vec4 ground(ivec2 pixel, float shade) {
    vec3 bare = clamp(texelFetch(base_texture, pixel, 0).rgb * shade, 0.0, 1.0);
#ifdef OVERLAY
    vec4 overlay = texelFetch(overlay_texture, pixel, 0);
    vec3 lit = clamp(overlay.rgb * mix(1.0, shade, layer_shading), 0.0, overlay.a);
    return vec4(lit + (1.0 - overlay.a) * bare, 1.0);
#else
    return vec4(bare, 1.0);
#endif
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 surface = texelFetch(surface_texture, pixel, 0);
    color = isinf(surface.z) ? sky() : ground(pixel, surface.w);
#ifdef SAMPLE
    color.rgb *= color.a;
#endif
}

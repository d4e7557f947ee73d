// The depth of what each pixel sees, where its own ray meets the surface: the volumes are counted against it.
#include "shared/ray.glsl"

uniform sampler2D surface_texture;

void main() {
    float distance = texelFetch(surface_texture, ivec2(gl_FragCoord.xy), 0).z;
    vec2 pixel = pixel_from_centre();
    vec4 clip = clip_from_base * vec4(ray_origin_at(pixel) + distance * ray_direction_at(pixel), 1.0);
    // Nothing lies behind the sky.
    gl_FragDepth = isinf(distance) ? 0.0 : clip.z / clip.w;
}

// The depth of what each pixel sees, where its own ray meets the surface: the volumes are counted against it.
//
// LENS    what is on the other side of the lens is as far away as the sky
#include "shared/ray.glsl"

uniform sampler2D surface_texture;
#ifdef LENS
uniform sampler2D lens_texture;  // the share of a pixel that is inside, and whether its centre is
uniform int lens_side;           // 1: inside
#endif

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    float distance = texelFetch(surface_texture, texel, 0).z;
    vec2 pixel = pixel_from_centre();
    vec4 clip = clip_from_base * vec4(ray_origin_at(pixel) + distance * ray_direction_at(pixel), 1.0);
    bool is_seen = !isinf(distance);
#ifdef LENS
    is_seen = is_seen && int(texelFetch(lens_texture, texel, 0).y) == lens_side;
#endif
    // Nothing lies behind the sky.
    gl_FragDepth = is_seen ? clip.z / clip.w : 0.0;
}

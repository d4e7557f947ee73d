// The lens's mask: the share of a pixel that is inside, as if its border were straight there, and whether its centre is.
//
// GATHERED   samples of pixels from anywhere in the picture
// ON_MAP   rings on the map, inside by the even-odd rule; else a circle on the screen
#include "shared/ray.glsl"
#include "shared/position.glsl"

layout(location = 0) out vec2 mask;

#ifdef ON_MAP
uniform usampler2D position_texture;
uniform sampler2D surface_texture;
uniform samplerBuffer lens_edges;  // from x, y to x, y, in metres from lens_block's lower left corner
uniform int edge_count;
uniform ivec2 lens_block;
#else
uniform vec3 circle;  // centre and radius, in pixels from the picture's lower left corner
#endif

vec2 mask_of(bool inside, float distance_to_border) {
    return vec2(clamp(0.5 + (inside ? distance_to_border : -distance_to_border), 0.0, 1.0), float(inside));
}

#ifdef ON_MAP
void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    Position seen = unpack_position(texelFetch(position_texture, pixel, 0));
    vec4 surface = texelFetch(surface_texture, pixel, 0);
    vec2 at = vec2(seen.block - lens_block) * base_offset.z + seen.offset;
    mat2 pixels_from_metres = inverse(footprint(pixel_from_centre(), surface.xy, surface.z));
    bool inside = false;
    float nearest = 1e30;
    int i = 0;
    do {
        vec4 edge = texelFetch(lens_edges, i);
        bool spans = (edge.y > at.y) != (edge.w > at.y);
        float crossing = edge.x + (edge.z - edge.x) * (at.y - edge.y) / (edge.w - edge.y);
        inside = inside != (spans && at.x < crossing);
        vec2 from = pixels_from_metres * (edge.xy - at), along = pixels_from_metres * (edge.zw - edge.xy);
        float t = clamp(-dot(from, along) / max(dot(along, along), 1e-12), 0.0, 1.0);
        nearest = min(nearest, length(from + t * along));
    } while (++i < edge_count);
    mask = is_sky(seen) ? vec2(0.0) : mask_of(inside, nearest);
}
#else
void main() {
    float apart = length(pixel_from_centre() + 0.5 * spacing.zw - circle.xy);
    mask = mask_of(apart <= circle.z, abs(circle.z - apart));
}
#endif

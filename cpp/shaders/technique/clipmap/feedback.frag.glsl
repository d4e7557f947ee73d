// Which tiles a pixel needs, for every eighth pixel: its texel of the finest level, the level of detail, samples.
#include "technique/clipmap/place.glsl"

layout(location = 0) out ivec4 needed;

uniform int step_size;

void main() {
    ivec2 pixel = min(ivec2(gl_FragCoord.xy) * step_size + step_size / 2, textureSize(position_texture, 0) - 1);
    Position position = unpack_position(texelFetch(position_texture, pixel, 0));
    vec4 surface = texelFetch(surface_texture, pixel, 0);
    vec2 from_centre = vec2(pixel) + 0.5 + vec2(picture.xy) - 0.5 * spacing.zw + jitter.xy;
    Place place = place_of(position, surface, from_centre);
    needed = is_sky(position) ? ivec4(0, 0, -1, 0) : ivec4(place.texel, int(floor(place.level)), int(place.taps));
}

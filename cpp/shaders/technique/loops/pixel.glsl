// What is known of a pixel before features are looked up, and what is written of it.
//
// SAMPLES            its footprint is asked for
// TESTED, ACTIVE     heat maps
// LENS               one side of the lens's border
// IDS                an id is written, by the centre
#include "shared/ray.glsl"
#ifdef IDS
#undef SAMPLES
#endif
#if defined(TESTED) || defined(ACTIVE)
#include "technique/loops/heat.glsl"
#endif
#ifdef LENS
#include "technique/loops/lens.glsl"
#endif

uniform usampler2D position_texture;
#ifdef SAMPLES
uniform sampler2D surface_texture;
#endif

#ifdef IDS
layout(location = 0) out uint id;
#else
layout(location = 0) out vec4 color;
#endif

#ifdef SAMPLES
// Metres on the map for one pixel to the right and one up.
mat2 footprint_of(ivec2 pixel) {
    vec4 surface = texelFetch(surface_texture, pixel, 0);
    return footprint(pixel_from_centre(), surface.xy, surface.z);
}
#endif

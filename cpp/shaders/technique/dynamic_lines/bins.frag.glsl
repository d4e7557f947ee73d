// Lines out of the tiles of the screen (bins_layout.h): a pixel looks through its tile's segments from the topmost down.
//
// Each segment lies on the plane of the ground that this pixel sees (screen_plane.glsl), so lines bend over the terrain
// and hide behind it without a depth of their own.
//
// COVERAGE      64 samples of the pixel at once (shared/sample_masks.glsl)
// UNION         all that is shown looks the same and is opaque; not with IDS
// TRANSLUCENT   some colour is
// JOINED        corners and caps that are not round
// STYLED        patterns along lines, and colours across; goes with JOINED
// SIDES         inset and offset outlines
// LIMITS        widths that depend on the depth
// LENS          other looks inside the lens
// GATHERED      texels are samples of pixels from anywhere in the picture
// IDS           1 + slot at the pixel's centre, whatever the flags above say
#ifdef IDS
#undef COVERAGE
#undef UNION
#endif
#include "shared/position.glsl"
#include "shared/stroke.glsl"
#include "technique/dynamic_lines/bins_segments.glsl"
#ifdef SIDES
#include "technique/dynamic_lines/bins_sides.glsl"
#endif
#ifdef COVERAGE
#include "technique/dynamic_lines/bins_coverage.glsl"
#else
#include "technique/dynamic_lines/bins_centre.glsl"
#endif

uniform sampler2D surface_texture;
#ifdef LENS
uniform sampler2D lens_texture;
#endif

#ifdef IDS
layout(location = 0) out uint out_id;
#else
layout(location = 0) out vec4 out_color;  // premultiplied
#endif

ivec2 list_range() {
#ifdef GATHERED
    ivec2 pixel = gathered_pixel();
#else
    ivec2 pixel = ivec2(gl_FragCoord.xy);
#endif
    ivec2 tile = (pixel + picture.xy) / TILE_SIDE;
    return range_of_tile(tile.y * tile_grid.x + tile.x);
}

#ifdef IDS

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 surface = texelFetch(surface_texture, pixel, 0);
    out_id = 0u;
    if (isinf(surface.z)) return;
#ifdef LENS
    if (texelFetch(lens_texture, pixel, 0).g > 0.5) first_style = lens_styles;
#endif
    uint topmost = composed(screen_plane(pixel_from_centre(), surface), list_range()).topmost;
    if (topmost != no_slot) out_id = topmost + 1u;
}

#else

vec4 color_in(ScreenPlane plane, ivec2 range) {
#ifdef COVERAGE
    return composed(plane, range);
#else
    return composed(plane, range).sum;
#endif
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 surface = texelFetch(surface_texture, pixel, 0);
    out_color = vec4(0.0);
    if (isinf(surface.z)) return;
    ScreenPlane plane = screen_plane(pixel_from_centre(), surface);
#ifdef LENS
    float inside = texelFetch(lens_texture, pixel, 0).r;
    vec4 outer = color_in(plane, list_range());
    first_style = lens_styles;
    vec4 inner = color_in(plane, list_range());
    out_color = mix(outer, inner, inside);
#else
    out_color = color_in(plane, list_range());
#endif
}

#endif

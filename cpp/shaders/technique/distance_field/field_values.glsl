// What the values of a field mean: what the passes that write and that read it have in common.
//
// A field reaches from the line to its border, some slack and, with ANGLES, as many pixels as coverage looks beyond
// it. The pass that reads it works the reach out again, from the surface that the pixel sees.
#include "technique/distance_field/styles.glsl"

uniform usampler2D position_texture;
uniform sampler2D surface_texture;

const float coverage_pixels = 1.5;

struct Surface {
    vec2 gradient;
    float distance;   // along the ray
    mat2 footprint;   // metres on the map for a pixel to the right and one up
    float pixel;      // the most that a step of a pixel covers
};

// Of the G-buffer's values at a pixel.
Surface surface_of(vec3 values, vec2 pixel) {
    mat2 metres = footprint(pixel, values.xy, values.z);
    return Surface(values.xy, values.z, metres, length(metres[0]) + length(metres[1]));
}

Surface surface_at(ivec2 texel) {
    return surface_of(texelFetch(surface_texture, texel, 0).xyz, pixel_from_centre());
}

Seen seen_from(Position position, Surface surface) {
    vec2 pixel = pixel_from_centre();
    vec2 place = vec2(position.block - base_block.xy) * base_offset.z + (position.offset - base_offset.xy);
    vec3 at = ray_origin_at(pixel) + surface.distance * ray_direction_at(pixel);
    return Seen(place, forward.w + surface.distance, dot(at, camera_right()), pixel / spacing.zw + 0.5);
}

float reach_of(Category category, Surface surface) {
    float margin = 0.0;
#ifdef ANGLES
    margin = coverage_pixels * category.margin_scale * surface.pixel;
#endif
    return category.reach * FIELD_SLACK + margin;
}

// Where in the field a line of this style ends.
float border_distance(Category category, Style style) {
#ifdef VERTEX_WIDTHS
    return category.reach;
#else
    return style.half_width;
#endif
}

float slope_width(float slope, Surface surface) {
#ifdef SLOPES
    return slope == 1.0 ? thoeny_width(surface.gradient, forward.z) : 1.0;
#else
    return 1.0;
#endif
}

// What a length of line is repeated after: of its pattern, else of its raster.
float period_of(int category) {
    float pattern = category_texel(category, 2).z;
    return pattern > 0.0 ? pattern : category_texel(category, 3).y;
}

// The share of the width that a pattern leaves at a length; 1 without a pattern, below 0 between marks.
float mark_share(int category, float along) {
    vec4 pattern = category_texel(category, 2);
    if (!(pattern.z > 0.0)) return 1.0;
    float phase = pattern_phase(along + pattern.w, pattern.z);
    float widest = -1.0;
    int i = 0;
    do {
        if (i >= int(pattern.y)) break;
        widest = max(widest, mark_width(texelFetch(network_styles, int(pattern.x) + i), phase));
        ++i;
    } while (true);
    return widest;
}

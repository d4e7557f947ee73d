// Styles of categories by level of detail (Trapp et al. 2015, sections 4.3 and 5.3).
//
//     lod     one value; the eye's distance; or a texture on the map, on the screen or before the camera
//     style   between the two tuples of a category whose lod it lies between
#include "shared/view_block.h"
#include "technique/distance_field/network_layout.h"

uniform samplerBuffer network_styles;

// decalgl/technique/distance_field_options.h
const int lod_by_value = 0;
const int lod_by_distance = 1;
const int lod_on_map = 0;
const int lod_on_screen = 1;

uniform int lod_source;
uniform int lod_space;
uniform float lod_value;
uniform vec2 lod_range;   // near, far
uniform vec4 lod_extent;  // lower left corner; one by width and height
uniform sampler2D lod_texture;

// A place that is seen: on the map relative to the base, by the camera, and on the screen from 0 to 1.
struct Seen {
    vec2 place;
    float depth;
    float lateral;  // metres to the right of the camera's axis
    vec2 screen;
};

vec3 camera_right() {
    return normalize(ray_origin_dx.xyz + ray_direction_dx.xyz);
}

float lod_of_depth(float depth) {
    return clamp((depth - lod_range.x) / (lod_range.y - lod_range.x), 0.0, 1.0);
}

float lod_at(Seen seen) {
    vec2 place = lod_space == lod_on_map      ? seen.place
                 : lod_space == lod_on_screen ? seen.screen
                                              : vec2(seen.lateral, seen.depth);
    float from_texture = textureLod(lod_texture, (place - lod_extent.xy) * lod_extent.zw, 0.0).r;
    return lod_source == lod_by_value      ? lod_value
           : lod_source == lod_by_distance ? lod_of_depth(seen.depth)
                                           : from_texture;
}

struct Category {
    int first_tuple;
    int tuples;
    float reach;
    float margin_scale;
};

// A texel of a category's header.
vec4 category_texel(int index, int which) {
    return texelFetch(network_styles, index * CATEGORY_TEXELS + which);
}

Category category_at(int index) {
    vec4 texel = category_texel(index, 0);
    return Category(int(texel.x), int(texel.y), texel.z, texel.w);
}

struct Style {
    float half_width;
    float main;           // share of it in the main colour
    float texture_share;
    vec4 main_color;      // straight alpha
    vec4 border_color;
};

Style style_at(Category category, float lod) {
    int upper = 0;
    do {
        if (texelFetch(network_styles, category.first_tuple + upper * TUPLE_TEXELS).x >= lod) break;
        ++upper;
    } while (upper < category.tuples);
    int b = category.first_tuple + min(upper, category.tuples - 1) * TUPLE_TEXELS;
    int a = category.first_tuple + max(upper - 1, 0) * TUPLE_TEXELS;
    vec4 sizes_a = texelFetch(network_styles, a);
    vec4 sizes_b = texelFetch(network_styles, b);
    float share = clamp((lod - sizes_a.x) / max(sizes_b.x - sizes_a.x, 1e-6), 0.0, 1.0);
    vec4 sizes = mix(sizes_a, sizes_b, share);
    vec4 main_color = mix(texelFetch(network_styles, a + 1), texelFetch(network_styles, b + 1), share);
    vec4 border_color = mix(texelFetch(network_styles, a + 2), texelFetch(network_styles, b + 2), share);
    return Style(sizes.y, sizes.z, sizes.w, main_color, border_color);
}

// Styles from the fields, category by category from the bottom (Trapp et al. 2015, section 5.3).
//
//     borders over     each category's border and main colour over those below
//     UNDER            the main colours of all categories lie over the borders of all
//     SMOOTH           categories flow into each other: no border inside another's main colour, and where main
//                      colours overlap, a mean weighted by how near the lines are (figure 12)
//
// COVERAGE   the mean over the pixel's area, by its way across the line     LENGTHS, PHASES   patterns, rasters
// DEPTHS     levels of detail by each category's depth                      VERTEX_WIDTHS, SLOPES   as the fields
// LENS       one side of the lens's border
// GATHERED   texels are samples of pixels from anywhere in the picture: the fields are those of the pixel, of it and its
//            neighbours, that sees the ground nearest to the sample's, carried on to the sample
#include "shared/position.glsl"
#include "shared/ray.glsl"
#include "shared/stroke.glsl"
#if defined(COVERAGE) || defined(GATHERED)
#define ANGLES 1
#endif
#include "technique/distance_field/field_values.glsl"
#include "technique/distance_field/half_plane_area.glsl"

layout(location = 0) out vec4 color;

uniform int category_count;
uniform sampler2DArray cross_fields;
#ifdef LENGTHS
uniform sampler2DArray length_fields;
uniform sampler2DArray rasters;
#endif
#ifdef DEPTHS
uniform sampler2DArray depth_fields;
#endif
#ifdef LENS
uniform sampler2D lens_texture;  // the share of a pixel that is inside, and whether its centre is
uniform int lens_side;           // 1: inside
#endif

#ifdef GATHERED
uniform usampler2D drawn_positions;
uniform sampler2D drawn_surfaces;
const float farthest = 4.0;  // pixels that fields are carried on for
#endif

// Where fields are read, and how far the pixel's place on the map is from there.
struct Source {
    ivec2 texel;
    Surface surface;
    vec2 shift;
    bool is_near;
};

#ifdef GATHERED
Source source_of(Position position, Surface surface) {
    ivec2 middle = gathered_pixel(), best = middle;
    vec2 shift = vec2(1e30);
    for (int i = 0; i < 9; ++i) {
        ivec2 texel = clamp(middle + ivec2(i % 3, i / 3) - 1, ivec2(0), textureSize(drawn_positions, 0) - 1);
        Position drawn = unpack_position(texelFetch(drawn_positions, texel, 0));
        vec2 way = vec2(position.block - drawn.block) * base_offset.z + (position.offset - drawn.offset);
        if (!is_sky(drawn) && dot(way, way) < dot(shift, shift)) {
            shift = way;
            best = texel;
        }
    }
    vec2 pixel = vec2(best) + 0.5 + vec2(picture.xy) - 0.5 * spacing.zw;
    Surface drawn_surface = surface_of(texelFetch(drawn_surfaces, best, 0).xyz, pixel);
    return Source(best, drawn_surface, shift, length(shift) <= farthest * drawn_surface.pixel);
}
#else
Source source_of(Position position, Surface surface) {
    return Source(ivec2(gl_FragCoord.xy), surface, vec2(0.0), true);
}
#endif

// What a category covers of the pixel.
struct Layer {
    float whole;       // within its width
    float main;        // within the main colour's
    vec4 main_color;   // straight alpha
    vec4 border_color;
    float nearness;    // 1 on the line, 0 at its border
};

// From -1 to 1, changing over a length of 1.
float noise(vec2 place) {
    vec2 cell = floor(place), inside = place - cell;
    vec2 weight = inside * inside * (3.0 - 2.0 * inside);
    vec4 corners;
    for (int i = 0; i < 4; ++i) {
        vec2 corner = cell + vec2(i & 1, i >> 1);
        corners[i] = fract(sin(dot(corner, vec2(12.9898, 78.233))) * 43758.5453);
    }
    return 2.0 * mix(mix(corners.x, corners.y, weight.x), mix(corners.z, corners.w, weight.x), weight.y) - 1.0;
}

#ifdef LENGTHS
// The share of a pixel's length along the line that marks take up, and the share of the width there.
vec2 marks_at(int category, float along, float pixel) {
    vec4 pattern = category_texel(category, 2);
    if (!(pattern.z > 0.0)) return vec2(1.0);
#ifdef COVERAGE
    float phase = pattern_phase(along + pattern.w, pattern.z);
    float covered = 0.0, width = 0.0;
    int i = 0;
    do {
        if (i >= int(pattern.y)) break;
        vec4 mark = texelFetch(network_styles, int(pattern.x) + i);
        for (float turn = -1.0; turn <= 1.0; ++turn) {
            float begin = max(mark.x + turn * pattern.z, phase - 0.5 * pixel);
            float end = min(mark.y + turn * pattern.z, phase + 0.5 * pixel);
            float share = max(end - begin, 0.0) / pixel;
            covered += share;
            width += share * mix(mark.z, mark.w, clamp((0.5 * (begin + end) - turn * pattern.z - mark.x)
                                                       / max(mark.y - mark.x, 1e-6), 0.0, 1.0));
        }
        ++i;
    } while (true);
    return vec2(min(covered, 1.0), covered > 0.0 ? width / covered : 0.0);
#else
    float width = mark_share(category, along);
    return vec2(float(width >= 0.0), max(width, 0.0));
#endif
}

vec4 textured(int category, Style style, float along, float across) {
    vec4 raster = category_texel(category, 3);
    if (raster.x < 0.0 || style.texture_share <= 0.0) return style.main_color;
    vec4 texel = textureLod(rasters, vec3(along / raster.y, across, raster.x), 0.0);
    return mix(style.main_color, vec4(texel.rgb, texel.a * style.main_color.a), style.texture_share);
}
#endif

float cover(float distance, float half_width, float pixel, vec2 normal) {
#ifdef COVERAGE
    return strip_area(distance / pixel, half_width / pixel, normal);
#else
    return float(distance <= half_width);
#endif
}

Layer layer_at(int category, Source source, float lod, Surface surface) {
    vec4 field = texelFetch(cross_fields, ivec3(source.texel, category), 0);
    Category own = category_at(category);
#ifdef DEPTHS
    if (lod_source == lod_by_distance) lod = texelFetch(depth_fields, ivec3(source.texel, category), 0).r;
#endif
    Style style = style_at(own, lod);
    float slope = category_texel(category, 3).z;
    float thinner = slope_width(slope, surface);
    float half_width = border_distance(own, style) * thinner;
    float distance = field.r * reach_of(own, source.surface);
    float pixel = surface.pixel;
    vec2 normal = vec2(1.0, 0.0);
#ifdef ANGLES
    float angle = 6.2831853 * field.g;
    normal = vec2(cos(angle), sin(angle));
    vec2 metres = inverse(transpose(source.surface.footprint)) * normal;
#endif
#ifdef GATHERED
    distance = abs(distance + dot(normalize(metres), source.shift));
#endif
#ifdef COVERAGE
#ifdef SLOPES
    if (slope == 2.0) metres = inverse(tangent_lengths(surface.gradient)) * metres;
#endif
    pixel = 1.0 / length(metres);
#ifdef VERTEX_WIDTHS
    pixel *= own.reach / max(style.half_width, 1e-3 * own.reach);
#endif
#endif
    float share = 1.0;
    vec4 main_color = style.main_color;
#ifdef LENGTHS
    float along = texelFetch(length_fields, ivec3(source.texel, category), 0).r;
#ifdef PHASES
    along *= period_of(category);
#endif
    vec4 sketch = vec4(category_texel(category, 4).x, category_texel(category, 3).w, 0.0, 0.0);
    distance += sketch.x * half_width * noise(vec2(along / sketch.y, float(category) * 7.0));
    distance = max(distance, 0.0);
    vec2 marks = marks_at(category, along, max(pixel, 1e-6));
    share = marks.x;
    half_width *= marks.y;
    main_color = textured(category, style, along, distance / max(half_width * style.main, 1e-6));
#endif
    bool is_there = field.r < 1.0 && source.is_near && half_width > 0.0 && !isinf(surface.distance);
    float whole = is_there ? share * cover(distance, half_width, pixel, normal) : 0.0;
    float main = is_there ? share * cover(distance, half_width * style.main, pixel, normal) : 0.0;
    if (style.main <= 0.0) main = 0.0;
    float nearness = clamp(1.0 - distance / max(half_width, 1e-6), 0.0, 1.0);
    return Layer(whole, min(main, whole), main_color, style.border_color, nearness);
}

vec4 premultiplied(vec4 straight, float share) {
    return vec4(straight.rgb, 1.0) * (straight.a * share);
}

vec4 over(vec4 above, vec4 below) {
    return above + below * (1.0 - above.a);
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    Position position = unpack_position(texelFetch(position_texture, texel, 0));
    Surface surface = surface_at(texel);
    float lod = lod_at(seen_from(position, surface));
    Source source = source_of(position, surface);
    vec4 mains = vec4(0.0), borders = vec4(0.0);
    float covered = 0.0, weights = 0.0;
    int category = 0;
    do {
        Layer layer = layer_at(category, source, lod, surface);
#ifdef SMOOTH
        float weight = layer.main * layer.nearness * layer.nearness + 1e-6 * layer.main;
        mains += weight * premultiplied(layer.main_color, 1.0);
        weights += weight;
        covered = max(covered, layer.main);
        borders = over(premultiplied(layer.border_color, layer.whole), borders);
#elif defined(UNDER)
        mains = over(premultiplied(layer.main_color, layer.main), mains);
        borders = over(premultiplied(layer.border_color, layer.whole), borders);
#else
        mains = over(premultiplied(layer.main_color, layer.main)
                         + premultiplied(layer.border_color, layer.whole - layer.main),
                     mains);
#endif
    } while (++category < category_count);
#ifdef SMOOTH
    mains *= covered / max(weights, 1e-9);
#endif
    color = over(mains, borders);
#ifdef LENS
    float inside = texelFetch(lens_texture, texel, 0).x;
    color *= lens_side == 1 ? inside : 1.0 - inside;
#endif
}

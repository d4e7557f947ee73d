// The fields of one segment, into the layer of its category: how far the pixel's place on the map lies from it.
//
//     cross     0 on the line ... 1 where the field ends; with ANGLES also the way away from it, as a share of a turn
//     length    metres along the line; with PHASES a share of the category's period
//     depth     the eye's distance, as a level of detail
//
// All are blended by the least. Drop-offs are textures, one for segments and one for each shape of a cap (section
// 4.2): u goes along, away from the line's end, and v across.
//
// EXACT    distances are computed in place of looked up    NEAREST   the nearest segment's fields, by depth
// VERTEX_WIDTHS   as the geometry shader                   SLOPES    some widths follow the slope
// LENGTHS, PHASES, DEPTHS, ANGLES   as above               IDS       the feature's place in the draw order, instead
// LENS     ids on one side of the lens's border
#include "shared/position.glsl"
#include "shared/ray.glsl"
#include "shared/stroke.glsl"
#include "technique/distance_field/field_values.glsl"

flat in ivec2 start_block;
flat in vec2 start_offset;
flat in vec4 way;
flat in vec4 widths;
flat in ivec4 kinds;

uniform sampler2DArray drop_offs;

#ifdef IDS
layout(location = 0) out uint id;
uniform float order_count;
uniform int main_order;  // what main colours lie higher by, than borders
#ifdef LENS
uniform sampler2D lens_texture;  // the share of a pixel that is inside, and whether its centre is
uniform int lens_side;           // 1: inside
#endif
#else
#ifdef ANGLES
layout(location = 0) out vec2 cross_field;
#else
layout(location = 0) out float cross_field;
#endif
#ifdef LENGTHS
layout(location = 1) out float length_field;
#endif
#ifdef DEPTHS
layout(location = 2) out float depth_field;
#endif
#endif

const int round_shape = 1;
const int square_shape = 2;
const int butt_shape = 3;

// From 0 at the line to 1 where the field ends.
float drop_off(int shape, vec2 from) {
    vec2 size = vec2(textureSize(drop_offs, 0).xy);
    vec2 place = (clamp(from, 0.0, 1.0) * (size - 1.0) + 0.5) / size;
#ifdef EXACT
    if (shape == 0) return from.y;
    if (shape == round_shape) return length(from);
    if (shape == square_shape) return max(from.x, from.y);
    if (shape == butt_shape) return 1.0;
#endif
    return max(from.x, from.y) < 1.0 ? textureLod(drop_offs, vec3(place, shape), 0.0).r : 1.0;
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    Position position = unpack_position(texelFetch(position_texture, texel, 0));
    if (is_sky(position)) discard;
    Surface surface = surface_at(texel);
    int category = kinds.x;
    Category own = category_at(category);

    vec2 from = vec2(position.block - start_block) * base_offset.z + (position.offset - start_offset);
    vec2 along_way = way.xy * way.z;
    float slope = category_texel(category, 3).z;
#ifdef SLOPES
    mat2 lengths = slope == 2.0 ? tangent_lengths(surface.gradient) : mat2(1.0);
    from = lengths * from;
    along_way = lengths * along_way;
#endif
    float size = length(along_way);
    vec2 direction = size > 0.0 ? along_way / size : way.xy;
    float along = dot(from, direction);
    float share = size > 0.0 ? clamp(along / size, 0.0, 1.0) : 0.0;
    float across = abs(cross_product(direction, from));

    Seen seen = seen_from(position, surface);
    float half_width = mix(widths.x, widths.y, share);
#ifndef VERTEX_WIDTHS
    half_width = own.reach;
#endif
    float field_reach = reach_of(own, surface);
    // Metres count as if the line were as wide as its category at its widest.
    float stretch = half_width > 0.0 ? own.reach / half_width : 1e30;
    bool before = along < 0.0, behind = along > size;
    int shape = before ? kinds.y : behind ? kinds.z : 0;
    float beyond = before ? -along : behind ? along - size : 0.0;
    if ((before || behind) && shape == 0) discard;
    if (beyond > (before ? widths.z : widths.w)) discard;
    float value = drop_off(shape, vec2(beyond, across) * stretch / field_reach);
    if (!(value < 1.0)) discard;
    float metres_along = way.w + share * way.z;
#ifdef IDS
#ifdef LENS
    if (int(texelFetch(lens_texture, texel, 0).y) != lens_side) discard;
#endif
    Style style = style_at(own, lod_at(seen));
    float width = slope_width(slope, surface) * border_distance(own, style);
    float distance = value * field_reach;
    float mark = mark_share(category, metres_along);
    bool is_main = distance <= style.main * width;
    float alpha = is_main ? max(style.main_color.a, style.texture_share) : style.border_color.a;
    if (distance > width * mark || alpha <= 0.0) discard;
    id = uint(kinds.w);
    gl_FragDepth = float(kinds.w + (is_main ? main_order : 0)) / order_count;
#else
#ifdef ANGLES
    vec2 shift = shape == 0 ? vec2(-direction.y, direction.x) : before ? from : from - along_way;
#ifdef SLOPES
    shift = lengths * shift;
#endif
    vec2 gradient = transpose(surface.footprint) * shift;
    float angle = atan(gradient.y, gradient.x) / 6.2831853 + 1.0;
    cross_field = vec2(value, fract(angle));
#else
    cross_field = value;
#endif
#ifdef LENGTHS
#ifdef PHASES
    float period = period_of(category);
    length_field = fract(metres_along / period);
#else
    length_field = metres_along;
#endif
#endif
#ifdef DEPTHS
    depth_field = lod_of_depth(seen.depth);
#endif
#ifdef NEAREST
    gl_FragDepth = value;
#endif
#endif
}

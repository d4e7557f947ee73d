// The true picture of a pixel's area, by 32 samples held as bits of a word.
//
//     while samples are left: take the cell of one of them and all samples in it,
//         walk the cell once; each group answers with the mask of samples it covers
//         compose front to back, each sample for itself
//
// Every sample lies in one cell and is covered by exactly one of two neighbours, so no background shows through
// a shared border, and joints, caps and crossings need no special case. The samples are a scrambled
// (0, 5, 2)-net (Sobol' points), chosen for the smallest error on straight edges: tools/sample_pattern.py.
#include "technique/static_decals/cells.glsl"

const int sample_count = 32;
const uint all_samples = 0xFFFFFFFFu;

const vec2 sample_offsets[sample_count] = vec2[](
    vec2(-0.453125, 0.140625), vec2(0.078125, -0.421875), vec2(-0.109375, -0.015625), vec2(0.421875, 0.359375),
    vec2(-0.296875, -0.328125), vec2(0.203125, 0.046875), vec2(-0.234375, 0.484375), vec2(0.296875, -0.140625),
    vec2(-0.421875, -0.234375), vec2(0.015625, 0.421875), vec2(-0.046875, 0.078125), vec2(0.453125, -0.265625),
    vec2(-0.359375, 0.296875), vec2(0.140625, -0.109375), vec2(-0.171875, -0.484375), vec2(0.359375, 0.234375),
    vec2(-0.484375, -0.390625), vec2(0.109375, 0.171875), vec2(-0.078125, 0.328125), vec2(0.390625, -0.046875),
    vec2(-0.265625, 0.015625), vec2(0.234375, -0.359375), vec2(-0.203125, -0.171875), vec2(0.265625, 0.453125),
    vec2(-0.390625, 0.390625), vec2(0.046875, -0.203125), vec2(-0.015625, -0.296875), vec2(0.484375, 0.109375),
    vec2(-0.328125, -0.078125), vec2(0.171875, 0.265625), vec2(-0.140625, 0.203125), vec2(0.328125, -0.453125)
);

float half_extent(vec2 across) {
    return 0.5 * (abs(across.x) + abs(across.y));
}

// Samples inside the stroke of a line piece: distances along and across it are affine in the sample's place.
uint stroke_mask(vec4 piece, vec2 point, mat2 foot, float half_width2) {
    vec2 along = piece.zw - piece.xy;
    float run = length(along);
    vec2 axis = run > 0.0 ? along / run : vec2(1.0, 0.0);
    vec2 from = point - piece.xy;
    float t = dot(from, axis);
    float s = from.x * axis.y - from.y * axis.x;
    vec2 dt = axis * foot;
    vec2 ds = vec2(axis.y, -axis.x) * foot;
    float clearance = max(max(-t, t - run) - half_extent(dt), abs(s) - half_extent(ds));
    uint mask = 0u;
    if (clearance * max(clearance, 0.0) <= half_width2) {
        for (int i = 0; i < sample_count; ++i) {
            float ti = t + dot(dt, sample_offsets[i]);
            float si = s + dot(ds, sample_offsets[i]);
            float past = ti - clamp(ti, 0.0, run);
            mask |= uint(si * si + past * past <= half_width2) << i;
        }
    }
    return mask;
}

// Samples whose walk from the cell's corner crosses a ring piece (ring_cells.h).
uint crossing_mask(vec4 piece, vec2 point, mat2 foot) {
    vec2 along = piece.zw - piece.xy;
    vec2 from = point - piece.xy;
    float side = from.x * along.y - from.y * along.x;
    vec2 dside = vec2(along.y, -along.x) * foot;
    vec2 dy = vec2(foot[0].y, foot[1].y);
    float reach = half_extent(dy);
    float border = border_crossing(piece);
    bool meets_row = point.y + reach >= piece.y && point.y - reach < piece.w && side + half_extent(dside) >= 0.0;
    uint mask = 0u;
    if (meets_row || point.y + reach >= border) {
        for (int i = 0; i < sample_count; ++i) {
            float yi = point.y + dot(dy, sample_offsets[i]);
            float side_i = side + dot(dside, sample_offsets[i]);
            bool on_row = piece.y <= yi && yi < piece.w && side_i >= 0.0;
            mask |= uint(on_row != (border <= yi)) << i;
        }
    }
    return mask;
}

uint piece_mask(Group group, vec4 piece, vec2 local, mat2 foot) {
    vec2 point = local * group.scale + float(COORDINATE_BIAS);
    if (group.is_line) return stroke_mask(piece, point, foot * group.scale, group.half_width2);
    return crossing_mask(piece, point, foot);
}

// Front-to-back composition of masks. `open`: samples that still see something behind what was added.
struct Samples {
    uint open;
#ifdef TRANSLUCENT
    float clear[sample_count];  // how much of what lies behind shows through
#endif
};

vec4 add_layer(inout Samples samples, uint mask, vec4 straight) {
    mask &= samples.open;
#ifdef TRANSLUCENT
    float weight = 0.0;
    for (int i = 0; i < sample_count; ++i) {
        float taken = (mask >> i & 1u) != 0u ? samples.clear[i] * straight.a : 0.0;
        samples.clear[i] -= taken;
        weight += taken;
    }
    if (straight.a == 1.0) samples.open &= ~mask;
#else
    float weight = float(bitCount(mask));
    samples.open &= ~mask;
#endif
    return weight * vec4(straight.rgb, 1.0);
}

// `local`: the pixel's centre in quanta from this cell's corner; `inside`: the samples that lie in this cell.
vec4 composite_cell(ivec2 cell, vec2 local, mat2 foot, uint inside) {
    uvec2 range = cell_range(cell);
    Samples samples;
    samples.open = inside;
#ifdef TRANSLUCENT
    for (int i = 0; i < sample_count; ++i) samples.clear[i] = 1.0;
#endif
    Group group;
    uint covered = 0u;
    vec4 sum = vec4(0.0);
    // One step past the last texel, to end the last group.
    for (uint at = range.x; at <= range.y && range.x < range.y; ++at) {
        uvec2 texel = at < range.y ? texelFetch(cell_texels, int(at)).rg : uvec2(HEADER_MARK, 0u);
        if (is_header(texel)) {
            if (covered != 0u) sum += add_layer(samples, covered, color_of(group.slot));
            group = read_group(texel);
            covered = covers_corner(texel) ? all_samples : 0u;
            if (samples.open == 0u) at = range.y;
        } else {
            uint mask = piece_mask(group, read_piece(texel), local, foot);
            covered = group.is_line ? covered | mask : covered ^ mask;
        }
    }
    return sum;
}

vec2 cell_of_sample(vec2 local, mat2 foot, int index) {
    return floor((local + foot * sample_offsets[index]) / float(CELL_QUANTA));
}

// Samples that lie `step` cells away from the pixel's own.
uint samples_in_cell(vec2 local, mat2 foot, vec2 step) {
    uint mask = 0u;
    for (int i = 0; i < sample_count; ++i) mask |= uint(cell_of_sample(local, foot, i) == step) << i;
    return mask;
}

vec4 composite_area(CellPosition centre, mat2 foot) {
    vec2 reach = vec2(half_extent(vec2(foot[0].x, foot[1].x)), half_extent(vec2(foot[0].y, foot[1].y)));
    bool one_cell = all(greaterThanEqual(centre.local, reach)) &&
                    all(lessThan(centre.local + reach, vec2(CELL_QUANTA)));
    vec4 sum = vec4(0.0);
    for (uint left = all_samples; left != 0u;) {
        vec2 step = one_cell ? vec2(0.0) : cell_of_sample(centre.local, foot, findLSB(left));
        uint inside = one_cell ? all_samples : samples_in_cell(centre.local, foot, step);
        sum += composite_cell(centre.cell + ivec2(step), centre.local - step * float(CELL_QUANTA), foot, inside);
        left &= ~inside;
    }
    return sum / float(sample_count);
}

// The true picture of a pixel's area, by 32 samples held as bits of a word.
//
//     while samples are left: take the cell of one of them and all samples in it,
//         walk the cell once; each group answers with the mask of samples it covers
//         compose front to back, each sample for itself
//
// Every sample lies in one cell and is covered by exactly one of two neighbours, so no background shows through
// a shared border, and joints, caps and crossings need no special case. The samples are a scrambled
// (0, 5, 2)-net (Sobol' points), chosen for the smallest error on straight edges: tools/sample_pattern.py.
#include "shared/sample_offsets.glsl"
#include "technique/static_decals/point.glsl"
#include "technique/static_decals/levels.glsl"

const uint all_samples = 0xFFFFFFFFu;

// Pixels larger than this many cells are sampled point by point.
const float most_cells_across = 1.5;

float half_extent(vec2 across) {
    return 0.5 * (abs(across.x) + abs(across.y));
}

// The group that is being read, and the edge or the layer that comes next.
struct Group {
    uint slot;
    bool line;
    mat2 foot;         // in the group's units
    float reach;       // of the pixel's corners from its centre
    vec2 at;           // the pixel's centre, in the group's coordinates
    vec2 corner;       // from the cell's corner to the centre, in the group's units
    vec2 from;         // from the last word's point to the centre
    float half_width;  // of a line
    uint covered;      // samples
};

Group group_of(uint header, float bias, vec2 local, mat2 foot) {
    Group group;
    group.slot = header & SLOT_MASK;
    group.line = is_line(header);
    group.covered = (header & COVERS) != 0u ? all_samples : 0u;
    float scale = 1.0;
    group.half_width = 0.0;
#ifdef LINES
    vec2 stroke = group.line ? stroke_of(header) : vec2(1.0, 0.0);
    scale = stroke.x;
    group.half_width = stroke.y;
#endif
    group.foot = foot * scale;
    group.reach = 0.5 * (length(group.foot[0]) + length(group.foot[1]));
    group.at = local * scale + bias;
    // Rounded as what leads from the border's points is: not to be simplified.
    precise vec2 corner = group.at - bias;
    group.corner = corner;
    group.from = vec2(0.0);
    return group;
}

// An edge between `from` and `to`, which lead from its ends to the pixel's centre, decides for all samples alike, or for
// each by itself.
const uint for_each = 1u;  // no mask of all samples or none
uint alike_in_stroke(Group group, vec2 from, vec2 to) {
    vec2 along = from - to;
    float t = clamp(dot(from, along) / max(dot(along, along), 1e-6), 0.0, 1.0);
    float apart = length(from - t * along);
    if (apart > group.half_width + group.reach) return 0u;
    return apart + group.reach <= group.half_width ? all_samples : for_each;
}

// Samples inside the stroke: distances along and across the edge are affine in the sample's place.
uint stroke_mask(Group group, vec2 from, vec2 to) {
    vec2 along = from - to;
    float run = length(along);
    vec2 axis = run > 0.0 ? along / run : vec2(1.0, 0.0);
    float t = dot(from, axis);
    float s = from.x * axis.y - from.y * axis.x;
    vec2 dt = axis * group.foot;
    vec2 ds = vec2(axis.y, -axis.x) * group.foot;
    float half_width2 = group.half_width * group.half_width;
    uint mask = 0u;
    for (int i = 0; i < sample_count; ++i) {
        float ti = t + dot(dt, sample_offsets[i]);
        float si = s + dot(ds, sample_offsets[i]);
        float past = ti - clamp(ti, 0.0, run);
        mask |= uint(si * si + past * past <= half_width2) << i;
    }
    return mask;
}

// How the walk from the cell's corner meets a ring's edge (ring_cells.h): `above` is how far above the place where the
// border is crossed the pixel's centre is, and far below where it is not.
struct Crossing {
    vec2 low;  // from the lower end to the centre
    vec2 high;
    float side;
    vec2 side_step;
    vec2 rise;
    float above;
};

Crossing crossing_of(Group group, vec2 from, vec2 to) {
    bool starts_left = from.x == group.corner.x;
    bool ends_left = to.x == group.corner.x;
    bool rises = from.y >= to.y;
    Crossing crossing;
    crossing.low = rises ? from : to;
    crossing.high = rises ? to : from;
    vec2 along = crossing.low - crossing.high;
    crossing.side = crossing.low.x * along.y - crossing.low.y * along.x;
    crossing.side_step = vec2(along.y, -along.x) * group.foot;
    crossing.rise = vec2(group.foot[0].y, group.foot[1].y);
    crossing.above = starts_left == ends_left ? -1e9 : starts_left ? from.y : to.y;
    return crossing;
}

uint alike_in_crossing(Crossing crossing) {
    float reach = half_extent(crossing.rise), side_reach = half_extent(crossing.side_step);
    bool row_none = crossing.low.y + reach < 0.0 || crossing.high.y - reach >= 0.0 || crossing.side + side_reach < 0.0;
    bool row_all = crossing.low.y - reach >= 0.0 && crossing.high.y + reach < 0.0 && crossing.side - side_reach >= 0.0;
    bool border_all = crossing.above - reach >= 0.0;
    bool border_none = crossing.above + reach < 0.0;
    if (!(row_none || row_all) || !(border_none || border_all)) return for_each;
    return row_all != border_all ? all_samples : 0u;
}

uint crossing_mask(Crossing crossing) {
    uint mask = 0u;
    for (int i = 0; i < sample_count; ++i) {
        float rise = dot(crossing.rise, sample_offsets[i]);
        float side = crossing.side + dot(crossing.side_step, sample_offsets[i]);
        bool on_row = crossing.low.y + rise >= 0.0 && crossing.high.y + rise < 0.0 && side >= 0.0;
        mask |= uint(on_row != (crossing.above + rise >= 0.0)) << i;
    }
    return mask;
}

// Front-to-back composition of masks. `open`: samples that still see something behind what was added.
struct Samples {
    uint open;
    vec4 sum;
#ifdef TRANSLUCENT
    float clear[sample_count];  // how much of what lies behind shows through
#endif
};

void add_layer(inout Samples samples, uint mask, vec4 straight) {
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
    samples.sum += weight * vec4(straight.rgb, 1.0);
}

// Walks the list of a cell for the samples that lie in it. `local`: the pixel's centre in quanta from the cell's corner.
// Most edges decide for all samples alike: the inner loop goes on to the next one that does not.
vec4 composite_cell(Cell cell, vec2 local, mat2 foot, uint inside) {
    Samples samples;
    samples.open = inside;
    samples.sum = vec4(0.0);
#ifdef TRANSLUCENT
    for (int i = 0; i < sample_count; ++i) samples.clear[i] = 1.0;
#endif
    float bias = bias_of(cell.bits);
    int at = 4 * int(cell.entry >> COUNT_BITS);
    uint count = cell.entry & COUNT_ESCAPE;
    int end = count == COUNT_ESCAPE ? 0x7FFFFFFF : at + 4 * int(count);
    Group group = group_of(0u, bias, local, foot);
    bool ended = false;
    do {
        uint alike = all_samples;
        vec2 from = vec2(0.0), to = vec2(0.0);
        do {
            uint word = at < end ? texelFetch(cell_texels, at >> 2)[at & 3] : LIST_END;
            ++at;
            if (is_header(word)) {
                if (group.covered != 0u && is_shown(group.slot)) add_layer(samples, group.covered, color_of(group.slot));
                group = group_of(word, bias, local, foot);
                ended = word == LIST_END || samples.open == 0u;
            } else {
                to = group.at - point_of(word);
                from = starts_edge(word) ? to : group.from;
                group.from = to;
                if (group.line) {
                    alike = alike_in_stroke(group, from, to);
                    if (alike != for_each) group.covered |= alike;
                } else {
                    alike = starts_edge(word) ? 0u : alike_in_crossing(crossing_of(group, from, to));
                    if (alike != for_each) group.covered ^= alike;
                }
            }
        } while (alike != for_each && !ended);
        if (alike == for_each) {
            if (group.line) group.covered |= stroke_mask(group, from, to);
            else group.covered ^= crossing_mask(crossing_of(group, from, to));
        }
    } while (!ended);
    return samples.sum;
}

// Samples that lie in the cell, `centre` being the pixel's centre in quanta from the cell's corner.
uint samples_in_cell(vec2 centre, mat2 foot, float size) {
    uint mask = 0u;
    for (int i = 0; i < sample_count; ++i) {
        vec2 at = centre + foot * sample_offsets[i];
        mask |= uint(all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, vec2(size)))) << i;
    }
    return mask;
}

// Each sample by itself: where it lies in a cell that few others lie in.
vec4 composite_points(LatticePosition centre, mat2 foot) {
    vec4 sum = vec4(0.0);
    int i = 0;
    do {
        vec2 at = centre.fraction + foot * sample_offsets[i];
        vec2 whole = floor(at);
        sum += color_at(LatticePosition(centre.quantum + ivec2(whole), at - whole));
    } while (++i < sample_count);
    return sum / float(sample_count);
}

Cell cell_of_sample(LatticePosition centre, mat2 foot, int index) {
    return cell_at(centre.quantum + ivec2(floor(centre.fraction + foot * sample_offsets[index])));
}

// Cell by cell, each for all samples in it.
vec4 composite_cells(LatticePosition centre, mat2 foot) {
    vec4 sum = vec4(0.0);
    uint left = all_samples;
    do {
        int next = findLSB(left);
        Cell cell = cell_of_sample(centre, foot, next);
        vec2 local = vec2(centre.quantum - cell.corner) + centre.fraction;
        // The sample that the cell was looked up for is in it, whatever was rounded.
        uint inside = left & (samples_in_cell(local, foot, float(1 << cell.bits)) | 1u << next);
        sum += composite_cell(cell, local, foot, inside);
        left &= ~inside;
    } while (left != 0u);
    return sum / float(sample_count);
}

vec4 composite_area(LatticePosition centre, mat2 foot) {
#ifdef LEVELS
    if (spans_texels(foot)) return mean_of_levels(centre, foot);
#endif
    float size = max(length(foot[0]), length(foot[1]));
    if (size > most_cells_across * float(1 << cell_at(centre.quantum).bits)) return composite_points(centre, foot);
    return composite_cells(centre, foot);
}

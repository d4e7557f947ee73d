// The true picture of a pixel's area, by 32 samples held as bits of a word.
//
//     while samples are left: take the cell of one of them and all samples in it,
//         walk the cell once; each group answers with the mask of samples it covers
//         compose front to back, each sample for itself
//
// Every sample lies in one cell and is covered by exactly one of two neighbours, so no background shows through
// a shared border, and joints, caps and crossings need no special case. The samples are a scrambled
// (0, 5, 2)-net (Sobol' points), chosen for the smallest error on straight edges: tools/sample_pattern.py.
#include "shared/half_planes.glsl"
#include "shared/sample_offsets.glsl"
#include "technique/static_decals/point.glsl"
#include "technique/static_decals/levels.glsl"

const uint all_samples = 0xFFFFFFFFu;

// Pixels larger than this many cells are sampled point by point.
const float most_cells_across = 1.5;
const float most_cells_looked_into = 4.0;  // where strokes are drawn by their estimated coverage

// Whether strokes may have parts other than bars with discs at their ends, or are told sample by sample.
#if defined(STYLES) && (defined(JOINED) || defined(PATTERNS) || defined(BANDS) || defined(THOENY))
#define PARTS
#endif

float half_extent(vec2 across) {
    return 0.5 * (abs(across.x) + abs(across.y));
}

// The group that is being read, and the edge or the layer that comes next.
struct Group {
    uint slot;
    bool line;
    mat2 foot;         // in the group's units
    float reach;       // of the pixel's farthest corner from its centre
    vec2 at;           // the pixel's centre, in the group's coordinates
    vec2 corner;       // from the cell's corner to the centre, in the group's units
    vec2 from;         // from the last word's point to the centre
    vec2 before;       // from that of the word before it
    float half_width;  // of a line
    uint covered;      // samples
    uint beyond;       // of a line: those that may lie in the disc around its last point
#ifdef STYLES
    bool clip;         // only cuts the next group off
    Style style;
    mat2 metric;
#endif
#ifdef PARTS
    vec2 last;         // the last word's point
    Pen pen;
    Pen pen_before;    // the edge that comes next
    float run;         // its length on the map
#endif
};

#ifdef BANDS
float shares[sample_count];  // at which the group's stroke covers each sample
#endif

Group group_of(uint header, float bias, vec2 local, mat2 foot) {
    Group group;
    group.slot = header & SLOT_MASK;
    group.line = is_line(header);
    group.covered = (header & COVERS) != 0u ? all_samples : 0u;
    float scale = 1.0;
    group.half_width = 0.0;
#if defined(STYLES)
    group.clip = (header & CLIP) != 0u;
    group.style = style_of(group.slot, half_width_of(group.slot));
    group.style.half_width *= width_factor(group.style);
    group.metric = metric_of(group.style);
    scale = is_line(header) ? group.style.scale : 1.0;
    group.half_width = group.style.half_width;
    foot = group.metric * foot;
#elif defined(LINES)
    vec2 stroke = is_line(header) ? stroke_of(header) : vec2(1.0, 0.0);
    scale = stroke.x;
    group.half_width = stroke.y;
#endif
#ifdef PARTS
    group.pen = group.pen_before = lifted_pen;
    group.run = 0.0;
    group.last = vec2(-1.0);
#endif
#ifdef BANDS
    for (int i = 0; i < sample_count; ++i) shares[i] = group.covered != 0u ? 0.0 : not_covered;
#endif
    group.foot = foot * scale;
    group.reach = 0.5 * max(length(group.foot[0] + group.foot[1]), length(group.foot[0] - group.foot[1]));
    group.at = local * scale + bias;
    // Rounded as what leads from the border's points is: not to be simplified.
    precise vec2 corner = group.at - bias;
    group.corner = corner;
    group.from = group.before = vec2(0.0);
    group.beyond = 0u;
    return group;
}

// Known while compiling where all are of one kind, so that the other kind's code is left out.
bool is_stroke(Group group) {
#if defined(LINES) && defined(RINGS)
    return group.line;
#elif defined(LINES)
    return true;
#else
    return false;
#endif
}

// An edge between `from` and `to`, which lead from its ends to the pixel's centre, decides for all samples alike, or for
// each by itself.
const uint for_each = 1u;  // no mask of all samples or none
uint alike_in_stroke(Group group, vec2 from, vec2 to) {
    vec2 along = from - to;
    float length2 = dot(along, along);
    float wide = group.half_width * sqrt(length2);
    float t = dot(from, along);
    float across = abs(from.x * along.y - from.y * along.x);
    // How far the pixel reaches along the edge and across it: most pixels near a border are told by these.
    float t_reach = half_extent(along * group.foot);
    float across_reach = half_extent(vec2(along.y, -along.x) * group.foot);
    bool apart = across > wide + across_reach || t + t_reach < -wide || t - t_reach > length2 + wide;
    bool within = across + across_reach <= wide && t >= t_reach && t + t_reach <= length2;
    // Around an end, or a point, the farthest corner decides.
    float outer = group.half_width + group.reach, inner = max(group.half_width - group.reach, 0.0);
    float from_end2 = dot(to, to);
    bool is_point = length2 == 0.0;
    if (is_point ? from_end2 > outer * outer : apart) return 0u;
    bool near_line = t >= 0.0 && t <= length2 && across * across < inner * inner * length2;
    return from_end2 < inner * inner || near_line || within && !is_point ? all_samples : for_each;
}

#ifdef PARTS
// How far a mitred corner reaches, in half widths.
float longest_reach(Style style) {
    return has(style, STYLE_MITER) ? inversesqrt(max(0.5 * (1.0 + style.miter_turn), 1e-4)) : 1.0;
}

// As above of the edge that comes next.
uint alike_in_styled(Group group, vec2 from, vec2 to) {
    vec2 along = from - to;
    float run = length(along);
    float t = dot(from, along) / max(run, 1e-6);
    float past = t - clamp(t, 0.0, run);
    float across = abs(from.x * along.y - from.y * along.x) / max(run, 1e-6);
    float apart = run > 0.0 ? sqrt(across * across + past * past) : length(from);
    if (apart > group.half_width * longest_reach(group.style) + group.reach) return 0u;
    bool beside = abs(past) == 0.0 && t >= group.reach && t + group.reach <= run;
    bool even = !has(group.style, STYLE_PATTERN | STYLE_BANDS);
    return even && beside && across + group.reach <= group.half_width ? all_samples : for_each;
}

// Reads a stroke's next point, and says whether its edge decides for all samples alike.
uint next_alike(inout Group group, uint word, vec2 from, vec2 to) {
    vec2 point = point_of(word);
    bool starts = starts_edge(word);
    if (starts) {
        if (point != group.last) group.pen = lifted_pen;
        group.pen.awaits_phase = has(group.style, STYLE_PATTERN);
    }
    group.run = starts ? 0.0 : distance(point, group.last);
    group.last = point;
    group.pen_before = group.pen;
    if (!starts) move_on(group.pen, group.style, from, to, group.run);
    bool joined = has(group.style, STYLE_JOINED);
    return starts && joined ? 0u : alike_in_styled(group, from, to);
}

uint styled_mask(Group group, vec2 from, vec2 to) {
    uint mask = 0u;
    int i = 0;
    do {
        vec2 step = group.foot * sample_offsets[i];
        float share = stroke_share(group.style, group.pen_before, from + step, to + step, group.run);
        mask |= uint(share <= 1.0) << i;
#ifdef BANDS
        shares[i] = min(shares[i], share);
#endif
    } while (++i < sample_count);
    return mask;
}
#else
// Of these samples, those in the disc around a point; `from` leads from it to the pixel's centre.
uint samples_in_disc(Group group, vec2 from, uint samples) {
    uint mask = 0u;
    do {
        int i = max(findLSB(samples), 0);
        vec2 at = from + group.foot * sample_offsets[i];
        mask |= uint(dot(at, at) <= group.half_width * group.half_width) << i;
        samples &= samples - 1u;
    } while (samples != 0u);
    return mask;
}

// Adds an edge to a line: the rectangle along it, and what the disc around its beginning adds where the edge before
// ends; or, where there is no edge, what the disc around the end of the edge before adds. Few samples lie beyond the
// edges: discs take them one by one.
void add_edge(inout Group group, vec2 from, vec2 to, bool is_edge) {
    vec2 along = from - to;
    float run = length(along);
    vec2 axis = along / max(run, 1e-6);
    float t = dot(from, axis);
    float s = from.x * axis.y - from.y * axis.x;
    Direction across = direction_of(vec2(axis.y, -axis.x) * group.foot);
    Direction onwards = direction_of(axis * group.foot);
    uint beside = samples_beyond(across, s + group.half_width) & ~samples_beyond(across, s - group.half_width);
    uint begun = samples_beyond(onwards, t), ended = samples_beyond(onwards, t - run);
    if (is_edge) group.covered |= beside & begun & ~ended;
    uint corner = group.beyond & ~group.covered;
    if (is_edge) corner &= beside & ~begun;
    group.covered |= corner & samples_in_disc(group, from, corner);
    group.beyond = is_edge ? beside & ended : 0u;
}
#endif

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

// Edges that meet in a point have the same word for it, and polygons on both sides of an edge the same for the edge.
uint crossing_mask(Crossing crossing) {
    Direction up = direction_of(crossing.rise);
    uint low = samples_beyond(up, crossing.low.y), high = samples_beyond(up, crossing.high.y);
    uint on_row = low & ~high & samples_beyond(direction_of(crossing.side_step), crossing.side);
    uint border = samples_beyond(up, crossing.above);
    return on_row ^ border;
}

#ifndef PARTS
// Whether a stroke's next edge decides for all samples alike. A point that starts an edge does not where the edge before
// may end in this pixel.
uint next_alike(inout Group group, bool starts) {
    bool open_end = group.beyond != 0u;
    uint alike = alike_in_stroke(group, group.before, group.from);
    if (starts) alike = open_end ? for_each : 0u;
    if (alike != for_each) group.beyond = starts ? all_samples : 0u;
    return alike;
}
#endif

// Reads the group's next point, and says whether the edge to it decides for all samples alike.
uint read_point(inout Group group, uint word) {
#ifdef PATTERNS
    if (group.pen.awaits_phase) {
        group.pen.periods = float(word) / float(PHASE_ONE);
        group.pen.awaits_phase = false;
        return 0u;
    }
#endif
    vec2 to = group.at - point_of(word);
#ifdef STYLES
    if (is_stroke(group)) to = group.metric * to;
#endif
#ifdef PARTS
    group.before = starts_edge(word) ? to : group.from;
    group.from = to;
    if (is_stroke(group)) return next_alike(group, word, group.before, to);
#else
    group.before = group.from;
    group.from = to;
    if (is_stroke(group)) return next_alike(group, starts_edge(word));
#endif
    return starts_edge(word) ? 0u : alike_in_crossing(crossing_of(group, group.before, to));
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

#ifdef STYLES
// Samples that a fill's hatch covers.
uint shown_samples(Group group, Cell cell, vec2 local, mat2 foot) {
    uint mask = all_samples;
#ifdef HATCHES
    if (has(group.style, STYLE_HATCH)) {
        vec2 inside = vec2(cell.corner & (BUCKET_QUANTA - 1)) + local;
        int i = 0;
        do {
            if (!fill_shows(group.style, cell.corner >> BUCKET_BITS, inside + foot * sample_offsets[i])) mask &= ~(1u << i);
        } while (++i < sample_count);
    }
#endif
    return mask;
}

// Composes the group that ends. `open`: the samples that it is not cut off from.
void add_group(inout Samples samples, inout uint open, Group group, Cell cell, vec2 local, mat2 foot) {
    if (group.clip) {
        open = group.covered;
        return;
    }
    uint mask = group.covered & open;
    open = all_samples;
    if (!is_stroke(group)) mask &= shown_samples(group, cell, local, foot);
    if (mask == 0u || !is_shown(group.slot)) return;
    vec4 straight = color_of(group.slot);
#ifdef BANDS
    if (has(group.style, STYLE_BANDS)) {
        int i = 0;
        do {
            add_layer(samples, mask & (1u << i), band_color(group.style, straight, shares[i]));
        } while (++i < sample_count);
        return;
    }
#endif
    add_layer(samples, mask, straight);
}
#endif

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
#ifdef STYLES
    uint open = all_samples;
#endif
    bool ended = false;
    do {
        uint alike = all_samples;
        uint word;
        do {
            word = at < end ? texelFetch(cell_texels, at >> 2)[at & 3] : LIST_END;
            bool ends = is_header(word);
#ifndef PARTS
            // The last edge's end first; the header is read again.
            if (ends && is_stroke(group) && group.beyond != 0u) {
                alike = for_each;
                group.before = group.from;
                ends = false;
                --at;
            } else
#endif
            if (!ends) {
                alike = read_point(group, word);
                if (alike != for_each) group.covered = is_stroke(group) ? group.covered | alike : group.covered ^ alike;
            }
            ++at;
            if (ends) {
#ifdef STYLES
                add_group(samples, open, group, cell, local, foot);
#else
                if (group.covered != 0u && is_shown(group.slot)) add_layer(samples, group.covered, color_of(group.slot));
#endif
                group = group_of(word, bias, local, foot);
                ended = word == LIST_END || samples.open == 0u;
            }
        } while (alike != for_each && !ended);
        if (alike == for_each) {
#ifdef PARTS
            if (is_stroke(group)) group.covered |= styled_mask(group, group.before, group.from);
#else
            if (is_stroke(group)) {
                add_edge(group, group.before, group.from, !is_header(word) && !starts_edge(word));
                if (!is_header(word) && starts_edge(word)) group.beyond = all_samples;
            }
#endif
            else group.covered ^= crossing_mask(crossing_of(group, group.before, group.from));
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

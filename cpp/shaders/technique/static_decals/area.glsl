// The true picture of a pixel's area, by 64 samples held as bits of two words.
//
//     while samples are left: take the cell of one of them and all samples in it,
//         walk the cell once; each group answers with the mask of samples it covers
//         compose front to back, each sample for itself
//
// Every sample lies in one cell and is covered by exactly one of two neighbours, so no background shows through
// a shared border, and joints, caps and crossings need no special case. The samples are a scrambled
// (0, 6, 2)-net (Sobol' points), chosen for the smallest error on straight edges: tools/sample_pattern.py.
#include "shared/composed_samples.glsl"
#include "technique/static_decals/stroke_area.glsl"
#ifdef POINTS
#include "shared/sample_place.glsl"
#endif

// Pixels larger than this many cells are sampled point by point.
const float most_cells_across = 2.5;
const int most_borders = 16;  // those between fills are met from both sides, and strokes count twice
const float most_apart = 0.25;  // of what 64 points see, before more are looked at
const int following = 192;
// Mesa's software rasteriser ends a shader's loops after 65,535 turns, and more samples take four times as many.
const int most_words = 4096;
const int most_texels = 12288;
const float most_cells_looked_into = 4.0;  // where strokes are drawn by their estimated coverage

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
    return row_all != border_all ? for_all : for_none;
}

// Edges that meet in a point have the same word for it, and polygons on both sides of an edge the same for the edge.
uvec2 crossing_mask(Crossing crossing) {
    Direction up = direction_of(crossing.rise);
    uvec2 low = samples_beyond(up, crossing.low.y), high = samples_beyond(up, crossing.high.y);
    uvec2 on_row = low & ~high & samples_beyond(direction_of(crossing.side_step), crossing.side);
    uvec2 border = samples_beyond(up, crossing.above);
    return on_row ^ border;
}

// Reads the group's next point, and says whether the edge to it decides for all samples alike.
uint read_point(inout Group group, uint word) {
#ifdef PATTERNS
    if (group.pen.awaited > 0) {
        read_pattern(group.pen, word);
        return for_none;
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
    return starts_edge(word) ? for_none : alike_in_crossing(crossing_of(group, group.before, to));
}

#ifdef STYLES
// Of these samples, those that a fill's hatch covers.
uvec2 shown_samples(Group group, Cell cell, vec2 local, mat2 foot, uvec2 samples) {
    uvec2 mask = samples;
#ifdef HATCHES
    if (has(group.style, STYLE_HATCH)) {
        vec2 inside = vec2(cell.corner & (BUCKET_QUANTA - 1)) + local;
        float reach = hatch_reach(group.style);
        mask = no_samples;
        int i = 0;
        do {
            // Lines begin where a period does.
            vec3 spacings = spacings_of(group.style, i, cell.corner >> BUCKET_BITS, inside);
            Phase phase = phase_of(spacings.z + reach, spacings.xy * foot);
            mask |= samples_in_fine(phase, 0.0, 2.0 * reach, samples);
            vec2 turns = turns_of(phase, 0.0, 2.0 * reach);
            do {
                uvec2 line = samples_between(phase, turns.x, turns.x + 2.0 * reach);
                if (turns.x <= turns.y && !is_fine(phase)) mask |= line;
                turns.x += 1.0;
            } while (turns.x <= turns.y);
        } while (++i < hatch_sets(group.style));
    }
#endif
    return mask & samples;
}

// Composes the group that ends. `open`: the samples that it is not cut off from.
void add_group(inout Samples samples, inout uvec2 open, Group group, Cell cell, vec2 local, mat2 foot) {
    if (group.clip) {
        open = group.covered;
        return;
    }
    uvec2 mask = group.covered & open;
    open = all_samples;
    if (!is_stroke(group)) mask = shown_samples(group, cell, local, foot, mask);
    if (is_empty(mask) || !is_shown(group.slot)) return;
    vec4 straight = color_of(group.slot);
#ifdef BANDS
    if (has(group.style, STYLE_BANDS)) {
        int last = int(group.style.counts >> BANDS_SHIFT) - 1;
        uvec2 inner = no_samples;
        int i = 0;
        do {
            uvec2 band = i < last ? within_band[i] : group.covered;
            lay_under(samples, mask & band & ~inner, color_of_band(group.style, straight, i));
            inner |= band;
        } while (++i <= last);
        return;
    }
#endif
    lay_under(samples, mask, straight);
}
#endif

// What a pixel takes.
struct Effort {
    int borders;
    int words;
};

// Walks the list of a cell for the samples that lie in it. `local`: the pixel's centre in quanta from the cell's corner.
// Most edges decide for all samples alike: the inner loop goes on to the next one that does not.
// `effort` counts borders, which are rounded one by one, and words.
vec4 composite_cell(Cell cell, vec2 local, mat2 foot, uvec2 inside, inout Effort effort) {
    Samples samples = samples_of(inside);
    float bias = bias_of(cell.bits);
    int at = 4 * int(cell.entry >> COUNT_BITS);
    uint count = cell.entry & COUNT_ESCAPE;
    int end = count == COUNT_ESCAPE ? 0x7FFFFFFF : at + 4 * int(count);
    Group group = group_of(0u, bias, local, foot);
#ifdef STYLES
    uvec2 open = all_samples;
#endif
    bool ended = false;
    do {
        uint alike = for_all;
        uint word;
        do {
            word = at < end ? texel_at(at >> 2)[at & 3] : LIST_END;
            bool ends = is_header(word);
#ifndef PARTS
            // The last edge's end first; the header is read again.
            if (ends && is_stroke(group) && !is_empty(group.beyond)) {
                alike = for_each;
                group.before = group.from;
                ends = false;
                --at;
            } else
#endif
            if (!ends) {
                alike = read_point(group, word);
                if (alike != for_each) group.covered = is_stroke(group) ? group.covered | uvec2(alike) : group.covered ^ uvec2(alike);
            }
            ++at;
            if (ends) {
#ifdef STYLES
                add_group(samples, open, group, cell, local, foot);
#else
                if (!is_empty(group.covered) && is_shown(group.slot)) lay_under(samples, group.covered, color_of(group.slot));
#endif
                group = group_of(word, bias, local, foot);
                ended = word == LIST_END || is_empty(samples.open);
            }
        } while (alike != for_each && !ended);
        if (alike == for_each) {
            effort.borders += is_stroke(group) ? 2 : 1;
#ifdef PARTS
            if (is_stroke(group)) add_styled(group, group.before, group.from);
#else
            if (is_stroke(group)) {
                add_edge(group, group.before, group.from, !is_header(word) && !starts_edge(word));
                if (!is_header(word) && starts_edge(word)) group.beyond = all_samples;
            }
#endif
            else group.covered ^= crossing_mask(crossing_of(group, group.before, group.from));
        }
    } while (!ended);
    effort.words += at - 4 * int(cell.entry >> COUNT_BITS);
    return samples.sum;
}

// Samples that lie in the cell, `centre` being the pixel's centre in quanta from the cell's corner. Neighbours share out
// those near their border as the two sides of an edge do.
uvec2 samples_in_cell(vec2 centre, mat2 foot, float size) {
    Direction right = direction_of(vec2(foot[0].x, foot[1].x)), up = direction_of(vec2(foot[0].y, foot[1].y));
    return samples_beyond(right, centre.x) & ~samples_beyond(right, centre.x - size) & samples_beyond(up, centre.y) &
           ~samples_beyond(up, centre.y - size);
}

// A place that many quanta from another.
LatticePosition moved(LatticePosition from, vec2 by) {
    vec2 at = from.fraction + by;
    vec2 whole = floor(at);
    return LatticePosition(from.quantum + ivec2(whole), at - whole);
}

vec2 middle_of_quarter(int index) {
    return 0.5 * vec2(index & 1, index >> 1) - 0.25;
}

#ifdef POINTS
// Each sample by itself, where it lies in a cell that few others lie in. Where 64 differ, others in their place that follow
// the border: the way in which what is seen grows, in the channel where that is most, of samples that weigh the less the farther
// out they lie, as a square's corners mislead.
vec4 composite_points(LatticePosition centre, mat2 foot) {
    vec4 sum = vec4(0.0), least = vec4(1.0), most = vec4(0.0), right = vec4(0.0), up = vec4(0.0);
    vec2 growth = vec2(0.0);
    int i = 0, end = sample_count;
    do {
        bool follows = i >= sample_count;
        vec2 offset = follows ? sample_place(growth, i - sample_count, following) : sample_offsets[i];
        vec4 color = color_at(moved(centre, foot * offset));
        sum += color;
        least = min(least, color);
        most = max(most, color);
        vec4 weighed = max(0.45 - dot(offset, offset), 0.0) * color;
        right += offset.x * weighed;
        up += offset.y * weighed;
        ++i;
        if (i == sample_count && any(greaterThan(most - least, vec4(most_apart))) && walked_texels < most_texels) {
            for (int k = 0; k < 4; ++k) {
                vec2 own = vec2(right[k], up[k]);
                if (dot(own, own) > dot(growth, growth)) growth = own;
            }
            sum = vec4(0.0);
            end += following;
        }
    } while (i < end);
    return sum / float(end == sample_count ? sample_count : following);
}
#else
// Cell by cell, each for all samples in it.
vec4 composite_samples(LatticePosition centre, mat2 foot, out bool is_rough) {
    vec4 sum = vec4(0.0);
    uvec2 left = all_samples;
    Effort effort = Effort(0, 0);
    do {
        int next = first_of(left);
        Cell cell = cell_at(moved(centre, foot * sample_offsets[next]).quantum);
        vec2 local = vec2(centre.quantum - cell.corner) + centre.fraction;
        // The sample that the cell was looked up for is in it, whatever was rounded.
        uvec2 inside = left & (samples_in_cell(local, foot, float(1 << cell.bits)) | sample_if(true, next));
        sum += composite_cell(cell, local, foot, inside, effort);
        left &= ~inside;
    } while (!is_empty(left));
    is_rough = effort.borders > most_borders && effort.words < most_words;
    return sum / float(sample_count);
}

// A pixel that is rough is seen once more, by as many samples in each of its quarters.
vec4 composite_area(LatticePosition centre, mat2 foot) {
    vec4 sum = vec4(0.0), color = vec4(0.0);
    bool is_rough = false;
    int part = 0;
    do {
        bool whole = part == 0;
        bool rough;
        color = composite_samples(whole ? centre : moved(centre, foot * middle_of_quarter(part - 1)), whole ? foot : 0.5 * foot, rough);
        if (whole) is_rough = rough;
        else sum += 0.25 * color;
        ++part;
    } while (is_rough && part <= 4);
    return is_rough ? sum : color;
}
#endif

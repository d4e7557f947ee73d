// Which samples of a pixel's area the strokes of a list cover: bars, discs, corners, marks of patterns and bands, made of
// half planes.
#include "technique/static_decals/group.glsl"
#include "technique/static_decals/stretches.glsl"

// An edge between `from` and `to`, which lead from its ends to the pixel's centre, decides for all samples alike, or for
// each by itself.
const uint for_all = 0xFFFFFFFFu, for_none = 0u, for_each = 1u;
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
    if (is_point ? from_end2 > outer * outer : apart) return for_none;
    bool near_line = t >= 0.0 && t <= length2 && across * across < inner * inner * length2;
    return from_end2 < inner * inner || near_line || within && !is_point ? for_all : for_each;
}

// Of these samples, those in the disc around a point; `from` leads from it to the pixel's centre.
//
// Where the pixel is small against the disc, those beyond the line along its border there, moved inwards by what the
// border bends away from it on the mean: the 24th part of the squared chord over the radius.
uvec2 samples_in_disc(Group group, vec2 from, float radius, uvec2 samples) {
    uvec2 left = samples;
    float away = length(from);
    vec2 inwards = -from / max(away, 1e-6) * group.foot;
    float chord = abs(determinant(group.foot)) / max(2.0 * half_extent(inwards), 1e-30);
    bool is_flat = group.reach <= 0.75 * radius;
    uvec2 mask = samples & samples_beyond(direction_of(inwards), radius - chord * chord / (24.0 * radius) - away);
    if (is_flat) return mask;
    mask = no_samples;
    do {
        int i = first_of(left);
        vec2 at = from + group.foot * sample_offsets[i];
        mask |= sample_if(dot(at, at) <= radius * radius, i);
        left = without_first(left);
    } while (!is_empty(left));
    return mask & samples;
}

// An edge as the pixel sees it. `from` and `to` lead from its ends to the pixel's centre.
struct Bar {
    vec2 axis;
    float run;          // its length, as it is measured
    float t;            // how far the pixel's centre is along it
    float s;            // and across it
    Direction onwards;
    Direction across;
    uvec2 begun;        // samples beyond its beginning
    uvec2 ended;        // and beyond its end
};

Bar bar_of(Group group, vec2 from, vec2 to) {
    vec2 along = from - to;
    Bar bar;
    bar.run = length(along);
    bar.axis = along / max(bar.run, 1e-6);
    bar.t = dot(from, bar.axis);
    bar.s = from.x * bar.axis.y - from.y * bar.axis.x;
    bar.onwards = direction_of(bar.axis * group.foot);
    bar.across = direction_of(vec2(bar.axis.y, -bar.axis.x) * group.foot);
    bar.begun = samples_beyond(bar.onwards, bar.t);
    // From the end itself, as the corner there has it.
    bar.ended = samples_beyond(bar.onwards, dot(to, bar.axis));
    return bar;
}

// Samples that are no farther from the edge's line.
uvec2 samples_beside(Bar bar, float half_width) {
    return samples_beyond(bar.across, bar.s + half_width) & ~samples_beyond(bar.across, bar.s - half_width);
}

#ifdef PARTS
// How far a mitred corner reaches, or a dot's, in half widths.
float longest_reach(Style style, bool is_dot) {
    if (is_dot) return has(style, STYLE_SQUARE) ? sqrt(2.0) : 1.0;
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
    if (apart > group.half_width * longest_reach(group.style, run == 0.0) + group.reach) return for_none;
    bool beside = abs(past) == 0.0 && t >= group.reach && t + group.reach <= run;
    bool even = !has(group.style, STYLE_PATTERN | STYLE_BANDS);
    return even && beside && across + group.reach <= group.half_width ? for_all : for_each;
}

// Reads a stroke's next point, and says whether its edge decides for all samples alike.
uint next_alike(inout Group group, uint word, vec2 from, vec2 to) {
    vec2 point = point_of(word);
    bool starts = starts_edge(word);
    if (starts) move_pen(group.pen, group.style, point == group.last);
    group.run = starts ? 0.0 : run_of(group.pen, point, group.last);
    group.last = point;
    group.pen_before = group.pen;
    if (!starts) move_on(group.pen, group.style, from, to, group.run);
    bool joined = has(group.style, STYLE_JOINED);
    return starts && joined ? for_none : alike_in_styled(group, from, to);
}

#ifdef JOINED
// Those in a dot around a point; `from` leads from it to the pixel's centre.
uvec2 samples_in_dot(Group group, vec2 from, float half_width, uvec2 samples) {
    if (!has(group.style, STYLE_SQUARE)) return samples_in_disc(group, from, half_width, samples);
    Direction x = direction_of(vec2(1.0, 0.0) * group.foot), y = direction_of(vec2(0.0, 1.0) * group.foot);
    uvec2 beside_x = samples_beyond(x, from.x + half_width) & ~samples_beyond(x, from.x - half_width);
    uvec2 beside_y = samples_beyond(y, from.y + half_width) & ~samples_beyond(y, from.y - half_width);
    return beside_x & beside_y & samples;
}

// The corner before an edge, after one whose direction is `came`: what corner_reach tells of a point.
uvec2 samples_in_corner(Group group, vec2 from, vec2 came, Bar next, float half_width, uvec2 samples) {
    vec2 axis = normalize(came);
    float cosine = dot(axis, next.axis);
    bool is_bevel = has(group.style, STYLE_BEVEL);
    bool pointed = is_pointed(corner_of(group.style), axis, next.axis, -group.style.miter_turn);
    vec2 side = vec2(axis.y, -axis.x);
    Direction across = direction_of(side * group.foot);
    float s = dot(from, side);
    uvec2 beside = samples_beyond(across, s + half_width) & ~samples_beyond(across, s - half_width);
    uvec2 mask = samples_beyond(direction_of(axis * group.foot), dot(from, axis)) & ~next.begun & beside;
    mask &= samples_beside(next, half_width);
    vec2 u = axis - next.axis;
    float reach = length(u) * sqrt(max(0.5 * (1.0 + cosine), 0.0));
    // A line that goes straight on has no cut, and no corner either.
    if (is_bevel && dot(u, u) > 1e-8) mask &= samples_beyond(direction_of(-u * group.foot), half_width * reach - dot(from, u));
    uvec2 disc = samples_in_disc(group, from, half_width, pointed ? no_samples : samples);
    return pointed ? mask & samples : disc;
}
#endif

#ifdef PATTERNS
// Samples in the marks of a stroke's pattern, as far as they are wide. `run`: the edge's length on the pattern.
uvec2 samples_in_pattern(Group group, Bar bar, float periods, float run) {
    float per_unit = run / max(bar.run, 1e-6) * group.style.periods_per_unit;
    Phase phase = phase_of(periods + bar.t * per_unit, bar.axis * group.foot * per_unit);
    vec2 across = vec2(bar.axis.y, -bar.axis.x) * group.foot;
    uvec2 mask = no_samples;
    int i = 0;
    do {
        vec4 mark = record_texel(group.style.record + 1 + i);
        // Fine marks are as wide as they are on the mean.
        uvec2 fine = samples_beside(bar, group.half_width * 0.5 * (mark.z + mark.w)) & bar.begun & ~bar.ended;
        fine = samples_in_fine(phase, mark.x, mark.y, fine);
        float widens = group.half_width * (mark.w - mark.z) / max(mark.y - mark.x, 1e-9);
        Direction left = direction_of(widens * phase.growth + across), right = direction_of(widens * phase.growth - across);
        vec2 turns = turns_of(phase, mark.x, mark.y);
        uvec2 marks = no_samples;
        do {
            float half_width = group.half_width * mark.z + widens * (phase.centre - turns.x - mark.x);
            uvec2 beside = samples_beyond(left, half_width + bar.s) & samples_beyond(right, half_width - bar.s);
            uvec2 inside = beside & samples_between(phase, turns.x + mark.x, turns.x + mark.y);
            if (turns.x <= turns.y) marks |= inside;
            turns.x += 1.0;
        } while (turns.x <= turns.y);
        mask |= is_fine(phase) ? fine : marks;
    } while (++i < mark_count(group.style));
    return mask;
}
#endif

// Adds the edge that comes next, with the corner before it.
void add_styled(inout Group group, vec2 from, vec2 to) {
    Bar bar = bar_of(group, from, to);
    bool joined = has(group.style, STYLE_JOINED);
    bool is_dot = from == to;
    uvec2 marks = is_dot ? no_samples : bar.begun & ~bar.ended;
    float width = 1.0;
#ifdef PATTERNS
    if (has(group.style, STYLE_PATTERN)) {
        width = pattern_width(group.style, group.pen_before.periods);
        marks &= samples_in_pattern(group, bar, group.pen_before.periods, group.run);
    }
#endif
    int bands = 1;
#ifdef BANDS
    if (has(group.style, STYLE_BANDS)) bands = int(group.style.counts >> BANDS_SHIFT);
#endif
    int i = 0;
    do {
        float reach = 1.0;
        uvec2 covered = group.covered;
#ifdef BANDS
        if (i < bands - 1) {
            reach = uintBitsToFloat(texelFetch(style_records, band_record(group.style) + i).x);
            covered = within_band[i];
        }
#endif
        float half_width = group.half_width * min(reach, width);
        covered |= marks & samples_beside(bar, group.half_width * reach);
        // The disc around an end of a plain stroke, a dot, or a corner.
        if (!joined && width > 0.0) covered |= samples_in_disc(group, to, half_width, ~covered);
#ifdef JOINED
        if (joined && is_dot && width > 0.0) covered |= samples_in_dot(group, to, half_width, ~covered);
        if (joined && !is_dot && group.pen_before.has_came && width > 0.0) covered |= samples_in_corner(group, from, group.pen_before.came, bar, half_width, ~covered);
#endif
#ifdef BANDS
        if (i < bands - 1) within_band[i] = covered;
        else
#endif
        group.covered = covered;
    } while (++i < bands);
}
#else
// Adds an edge to a line: the rectangle along it, and what the disc around its beginning adds where the edge before
// ends; or, where there is no edge, what the disc around the end of the edge before adds.
void add_edge(inout Group group, vec2 from, vec2 to, bool is_edge) {
    Bar bar = bar_of(group, from, to);
    uvec2 beside = samples_beside(bar, group.half_width);
    if (is_edge) group.covered |= beside & bar.begun & ~bar.ended;
    uvec2 corner = group.beyond & ~group.covered;
    if (is_edge) corner &= beside & ~bar.begun;
    group.covered |= samples_in_disc(group, from, group.half_width, corner);
    group.beyond = is_edge ? beside & bar.ended : no_samples;
}
#endif

#ifndef PARTS
// Whether a stroke's next edge decides for all samples alike. A point that starts an edge does not where the edge before
// may end in this pixel.
uint next_alike(inout Group group, bool starts) {
    bool open_end = !is_empty(group.beyond);
    uint alike = alike_in_stroke(group, group.before, group.from);
    if (starts) alike = open_end ? for_each : for_none;
    if (alike != for_each) group.beyond = starts ? all_samples : no_samples;
    return alike;
}
#endif


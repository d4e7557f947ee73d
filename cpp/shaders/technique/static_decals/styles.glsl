// Styles that several decals share (style_records.h): what of a stroke or a hatched fill covers a point, and in which colour.
//
// After Zechmeister 2020, section 3.6: a point is in a stroke when it is beside a segment or in the corner between two
// (stroke.glsl). Each part answers with the share of the half width at which it would just cover the point, so that
// patterns that change the width, and colours across it, need no tests of their own.
#include "shared/stroke.glsl"
#include "technique/static_decals/style_records.h"

uniform usamplerBuffer decal_kinds;
uniform usamplerBuffer style_records;

const float not_covered = 2.0;

struct Style {
    uint flags;
    int record;  // its first texel
    float miter_turn;
    float periods_per_unit;
    uint counts;
    float scale;       // units per quantum
    float half_width;  // units
};

bool has(Style style, uint flag) {
    return (style.flags & flag) != 0u;
}

vec4 record_texel(int index) {
    return uintBitsToFloat(texelFetch(style_records, index));
}

// `half_width` in quanta.
Style style_of(uint slot, float half_width) {
#ifdef LENS_KINDS
    uint kind = texelFetch(decal_kinds, style_place(slot)).r;
#else
    uint kind = texelFetch(decal_kinds, int(slot)).r;
#endif
    Style style;
    style.record = int(kind >> SCALE_BITS);
    uvec4 first = texelFetch(style_records, style.record);
    style.scale = exp2(-float(kind & SCALE_MASK));
    style.half_width = half_width * style.scale;
    style.flags = first.x;
    style.miter_turn = uintBitsToFloat(first.y);
    style.periods_per_unit = uintBitsToFloat(first.z) / style.scale;
    style.counts = first.w;
    return style;
}

int mark_count(Style style) {
    return int(style.counts & COUNT_BITS_OF_MARKS);
}

// How wide the pattern lets the line be, as a share; below 0 where there is no mark.
float pattern_width(Style style, float periods) {
#ifdef PATTERNS
    if (!has(style, STYLE_PATTERN)) return 1.0;
    float widest = -1.0;
    int i = 0;
    do {
        widest = max(widest, mark_width(record_texel(style.record + 1 + i), fract(periods)));
    } while (++i < mark_count(style));
    return widest;
#else
    return 1.0;
#endif
}

// Where the walk along a stroke has come to: the edge before the next one, and how far along the pattern that begins.
struct Pen {
    vec2 came;
    bool has_came;
    int awaited;    // words of the pattern
    float periods;
    float slant;    // of lengths along the pattern
};

const Pen lifted_pen = Pen(vec2(0.0), false, 0, 0.0, 1.0);

// At a MOVE: whether the point is where the run has come to.
void move_pen(inout Pen pen, Style style, bool stays) {
    bool patterned = has(style, STYLE_PATTERN);
    if (!stays || !patterned) pen = lifted_pen;
    if (patterned) pen.awaited = has(style, STYLE_TANGENT) ? 2 : 1;
}

// A slant, of strokes that follow the ground, and then a phase.
void read_pattern(inout Pen pen, uint word) {
    if (--pen.awaited == 1) {
        pen.slant = uintBitsToFloat(word);
        return;
    }
    if ((word & PHASE_LIFTS) != 0u) pen.has_came = false;
    pen.periods = float(word & (uint(PHASE_ONE) - 1u)) / float(PHASE_ONE);
}

// The length of a stroke's next edge on its pattern, in units.
float run_of(Pen pen, vec2 point, vec2 last) {
    return pen.slant * distance(point, last);
}

// `run`: the edge's length on the pattern.
void move_on(inout Pen pen, Style style, vec2 from, vec2 to, float run) {
    vec2 goes = from - to;
    bool is_edge = goes != vec2(0.0);
    pen.came = is_edge ? goes : pen.came;
    pen.has_came = pen.has_came || is_edge;
    pen.periods += run * style.periods_per_unit;
}

float within_width(float share, float width) {
    return share <= width ? share : not_covered;
}

uint corner_of(Style style) {
    return has(style, STYLE_BEVEL) ? bevel_corner : has(style, STYLE_MITER) ? miter_corner : round_corner;
}

// The half width from which on a corner covers a point. `at` leads from the corner to it.
float joint_reach(Style style, vec2 at, vec2 came, vec2 goes) {
    return corner_reach(corner_of(style), at, normalize(came), normalize(goes), -style.miter_turn);
}

// Of a line without length, whose place `at` leads from.
float dot_reach(Style style, vec2 at) {
    return has(style, STYLE_SQUARE) ? max(abs(at.x), abs(at.y)) : length(at);
}

// The share at which a joined stroke's next edge covers a point, with the corner before it. `from` and `to` lead from
// the edge's ends to the point, `run` is its length on the pattern.
float joined_share(Style style, Pen pen, vec2 from, vec2 to, float run) {
    vec2 goes = from - to;
    float length_of_edge = length(goes);
    float width = pattern_width(style, pen.periods);
    if (length_of_edge == 0.0) return within_width(dot_reach(style, from) / style.half_width, width);
    float t = dot(from, goes) / length_of_edge;
    float s = abs(goes.x * from.y - goes.y * from.x) / length_of_edge;
    bool beside = t >= 0.0 && t <= length_of_edge;
    float there = pen.periods + t / length_of_edge * run * style.periods_per_unit;
    float share = beside ? within_width(s / style.half_width, pattern_width(style, there)) : not_covered;
    float at_joint = pen.has_came ? joint_reach(style, from, pen.came, goes) / style.half_width : not_covered;
    return min(share, within_width(at_joint, width));
}

// The same of a plain stroke: a bar, and the discs around both ends.
float plain_share(Style style, vec2 from, vec2 to) {
    vec2 goes = from - to;
    float t = clamp(dot(from, goes) / max(dot(goes, goes), 1e-6), 0.0, 1.0);
    return length(from - t * goes) / style.half_width;
}

float stroke_share(Style style, Pen pen, vec2 from, vec2 to, float run) {
#ifdef JOINED
    if (has(style, STYLE_JOINED)) return joined_share(style, pen, from, to, run);
#endif
    return plain_share(style, from, to);
}

#ifdef BANDS
int band_record(Style style) {
    return style.record + 1 + mark_count(style);
}

// The colour of a band, where the decal's own is `straight`.
vec4 color_of_band(Style style, vec4 straight, int band) {
    vec4 color = unpackUnorm4x8(texelFetch(style_records, band_record(style) + band).y);
    return vec4(color.rgb, color.a * straight.a);
}
#endif

// The colour at a share of the half width.
vec4 band_color(Style style, vec4 straight, float share) {
#ifdef BANDS
    int last = int(style.counts >> BANDS_SHIFT) - 1;
    int i = 0;
    if (has(style, STYLE_BANDS)) {
        while (i < last && share > uintBitsToFloat(texelFetch(style_records, band_record(style) + i).x)) ++i;
        return color_of_band(style, straight, i);
    }
#endif
    return straight;
}

#ifdef HATCHES
// Half the lines' width, in spacings: the same place in the record as a stroke's miter limit.
float hatch_reach(Style style) {
    return style.miter_turn;
}

int hatch_sets(Style style) {
    return int(texelFetch(style_records, style.record).z);
}

// How many spacings a place, in quanta from its bucket's corner, lies from a line of a set; in x and y, how many a quantum.
vec3 spacings_of(Style style, int set, ivec2 bucket, vec2 inside) {
    vec4 steps = record_texel(style.record + 1 + 2 * set);
    vec2 leaps = record_texel(style.record + 2 + 2 * set).xy;
    return vec3(steps.xy, dot(inside, steps.xy) + steps.z + fract(dot(vec2(bucket), leaps)));
}
#endif

// Whether a fill shows at a place, in quanta from its bucket's corner.
bool fill_shows(Style style, ivec2 bucket, vec2 inside) {
#ifdef HATCHES
    if (!has(style, STYLE_HATCH)) return true;
    bool shows = false;
    int i = 0;
    do {
        float spacings = spacings_of(style, i, bucket, inside).z;
        shows = shows || abs(spacings - round(spacings)) <= hatch_reach(style);
    } while (++i < hatch_sets(style));
    return shows;
#else
    return true;
#endif
}

#ifdef SLOPES
// How lengths on the map are seen on the surface at this pixel, and Thöny's factor of widths (2018, section 3.3).
mat2 slope_metric = mat2(1.0);
float slope_width = 1.0;

void set_slope(vec2 gradient) {
    slope_metric = tangent_lengths(gradient);
    slope_width = thoeny_width(gradient, forward.z);
}
#endif

// Vectors of a stroke as they are measured.
mat2 metric_of(Style style) {
#ifdef SLOPES
    if (has(style, STYLE_TANGENT)) return slope_metric;
#endif
    return mat2(1.0);
}

float width_factor(Style style) {
#ifdef SLOPES
    if (has(style, STYLE_THOENY)) return slope_width;
#endif
    return 1.0;
}

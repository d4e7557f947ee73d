// The group of a cell's list that is being read, and the pixel as its coordinates have it.
#include "shared/half_planes.glsl"
#include "technique/static_decals/point.glsl"

// Whether strokes may have parts other than bars with discs at their ends, or are told by their distance.
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
    uvec2 covered;      // samples
    uvec2 beyond;       // of a line: those that may lie in the disc around its last point
#ifdef STYLES
    bool clip;         // only cuts the next group off
    Style style;
    mat2 metric;
#endif
#ifdef PARTS
    vec2 last;         // the last word's point
    Pen pen;
    Pen pen_before;    // the edge that comes next
    float run;         // its length on the pattern
#endif
};

#ifdef BANDS
const int most_bands = 16;
uvec2 within_band[most_bands];  // samples that the group's stroke covers up to each of its bands but the last
#endif

Group group_of(uint header, float bias, vec2 local, mat2 foot) {
    Group group;
    group.slot = header & SLOT_MASK;
    group.line = is_line(header);
    group.covered = (header & COVERS) != 0u ? all_samples : no_samples;
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
    for (int i = 0; i < most_bands; ++i) within_band[i] = group.covered;
#endif
    group.foot = foot * scale;
    group.reach = 0.5 * max(length(group.foot[0] + group.foot[1]), length(group.foot[0] - group.foot[1]));
    group.at = local * scale + bias;
    // Rounded as what leads from the border's points is: not to be simplified.
    precise vec2 corner = group.at - bias;
    group.corner = corner;
    group.from = group.before = vec2(0.0);
    group.beyond = no_samples;
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

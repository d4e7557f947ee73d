// Which decals cover a point, where some have styles beyond plain strokes and even fills (styles.glsl): the walk of
// point.glsl with what those need.
#include "technique/static_decals/styles.glsl"

struct Walk {
    vec2 local;    // the point, in quanta from the cell's corner
    ivec2 bucket;
    vec2 inside;   // the point, in quanta from the bucket's corner
    float bias;
    vec2 at;       // the point, in the group's coordinates
    vec2 corner;   // from the cell's corner to the point, in the group's units
    vec2 last;     // the last word's point
    vec2 from;     // from there to the point, as it is measured
    uint slot;
    bool begun;
    bool line;
    bool clip;     // the group only cuts the next one off
    bool open;     // the group is not cut off
    float share;   // of the half width; 0 for fills that cover
    Style style;
    mat2 metric;
    Pen pen;
#if defined(FINDS_COLORS)
    vec4 found;
#elif defined(FINDS_ANY)
    bool found;
#else
    uint found;
#endif
};

Walk begin_walk(Cell cell, vec2 local) {
    Walk walk;
    walk.local = local;
    walk.bucket = cell.corner >> BUCKET_BITS;
    walk.inside = vec2(cell.corner & (BUCKET_QUANTA - 1)) + local;
    walk.bias = bias_of(cell.bits);
    walk.begun = false;
    walk.open = true;
    walk.share = not_covered;
    walk.slot = no_slot;
    walk.clip = false;
    walk.line = false;
#if defined(FINDS_COLORS)
    walk.found = vec4(0.0);
#elif defined(FINDS_ANY)
    walk.found = false;
#else
    walk.found = no_slot;
#endif
    return walk;
}

bool is_settled(Walk walk) {
#if defined(FINDS_COLORS)
    return walk.found.a >= 0.999;
#elif defined(FINDS_ANY)
    return walk.found;
#else
    return walk.found != no_slot;
#endif
}

void end_group(inout Walk walk) {
    bool covered = walk.begun && walk.share <= 1.0;
    if (walk.clip) {
        walk.open = covered;
        return;
    }
    covered = covered && walk.open && is_shown(walk.slot) && (walk.line || fill_shows(walk.style, walk.bucket, walk.inside));
    walk.open = true;
    if (!covered || is_settled(walk)) return;
#if defined(FINDS_COLORS)
    vec4 straight = band_color(walk.style, color_of(walk.slot), walk.share);
    walk.found += (1.0 - walk.found.a) * vec4(straight.rgb * straight.a, straight.a);
#elif defined(FINDS_ANY)
    walk.found = true;
#else
    walk.found = walk.slot;
#endif
}

void open_group(inout Walk walk, uint header) {
    walk.begun = header != LIST_END;
    if (!walk.begun) return;
    walk.slot = header & SLOT_MASK;
    walk.share = (header & COVERS) != 0u ? 0.0 : not_covered;
    walk.line = is_line(header);
    walk.clip = (header & CLIP) != 0u;
    walk.style = style_of(walk.slot, half_width_of(walk.slot));
    walk.style.half_width *= width_factor(walk.style);
    walk.metric = metric_of(walk.style);
    float scale = walk.line ? walk.style.scale : 1.0;
    walk.at = walk.local * scale + walk.bias;
    // Rounded as what leads from the border's points is: not to be simplified.
    precise vec2 corner = walk.at - walk.bias;
    walk.corner = corner;
    walk.pen = lifted_pen;
    walk.last = vec2(-1.0);
}

void read_stroke(inout Walk walk, vec2 point, bool starts) {
    vec2 to = walk.metric * (walk.at - point);
    bool joined = has(walk.style, STYLE_JOINED);
    if (starts) move_pen(walk.pen, walk.style, point == walk.last);
    vec2 from = starts ? to : walk.from;
    float run = starts ? 0.0 : run_of(walk.pen, point, walk.last);
    float share = starts && joined ? not_covered : stroke_share(walk.style, walk.pen, from, to, run);
    if (!starts) move_on(walk.pen, walk.style, from, to, run);
    walk.share = min(walk.share, share);
    walk.from = to;
}

void read_word(inout Walk walk, uint word) {
    if (is_header(word)) {
        end_group(walk);
        open_group(walk, word);
        return;
    }
    if (walk.pen.awaited > 0) {
        read_pattern(walk.pen, word);
        return;
    }
    vec2 point = point_of(word);
    bool starts = starts_edge(word);
    if (walk.line) {
        read_stroke(walk, point, starts);
    } else {
        vec2 to = walk.at - point;
        if (!starts && crosses_walk(walk.from, to, walk.corner)) walk.share = not_covered - walk.share;
        walk.from = to;
    }
    walk.last = point;
}

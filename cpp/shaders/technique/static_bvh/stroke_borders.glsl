// Borders of strokes in a pixel: their sides, ends and corners, their bands' and what patterns leave of them.
#include "technique/static_bvh/borders.glsl"

// The slot of the stroke that a segment of the cell belongs to, and whether it may show in the pixel.
struct Stroke {
    uint slot;
    bool shows;
};

#ifdef CORNERS
// How far past its ends a stroke may reach.
float longest_reach(Look look, float half_width) {
    float tip = look.corner == miter_corner ? inversesqrt(max(0.5 * (1.0 - look.limit), 1e-4)) : 1.5;
    return half_width * max(tip, 1.5);
}

// Of a corner or a cap at the beginning of a segment, or at its end: where `from` leads from.
void add_end(inout Borders borders, Run run, Look look, bool start, vec2 from, float width, mat2 foot) {
    vec2 incoming = start ? run.incoming : run.direction, outgoing = start ? run.direction : run.outgoing;
    bool is_cap = start ? incoming == vec2(0.0) : outgoing == vec2(0.0);
    float turn = dot(incoming, outgoing);
    bool is_round = is_cap ? look.cap == round_cap
                           : look.corner == round_corner || (look.corner == miter_corner && turn < -look.limit + 1e-5);
    if (is_round) add_circle(borders, from, width, foot);
    float past = dot(from, run.direction) * (start ? -1.0 : 1.0);
    if (is_cap && look.cap != round_cap)
        add_line(borders, run.direction, past - (look.cap == square_cap ? width : 0.0), foot);
    vec2 bend = incoming - outgoing;
    if (!is_cap && look.corner == bevel_corner && dot(bend, bend) > 1e-14)
        add_line(borders, normalize(bend), dot(from, normalize(bend)) - width * 0.5 * length(incoming + outgoing), foot);
}

#ifdef PATTERNS
// The ends and the sides of marks; whichever of them are near in the period.
void add_marks(inout Borders borders, Run run, Look look, int place, float half_width, mat2 foot) {
    vec2 sideways = vec2(-run.direction.y, run.direction.x) * (dot(run.from_start, vec2(-run.direction.y, run.direction.x)) < 0.0 ? -1.0 : 1.0);
    float phase = pattern_phase(run.phases.x + run.along, look.period);
    float reach = half_extent(run.direction * foot) / run.stretch;
    for (int i = 1; i <= look.marks; ++i) {
        vec4 mark = uintBitsToFloat(texelFetch(bvh_looks, place + i));
        for (int turn = -1; turn <= 1; ++turn) {
            float at = phase + float(turn) * look.period;
            add_line(borders, run.direction, (at - mark.x) * run.stretch, foot);
            add_line(borders, run.direction, (at - mark.y) * run.stretch, foot);
            if (at < mark.x - reach || at > mark.y + reach) continue;
            float rise = half_width * (mark.w - mark.z) / ((mark.y - mark.x) * run.stretch);
            float width = half_width * mark_width(mark, clamp(at, mark.x, mark.y));
            float steepness = sqrt(1.0 + rise * rise);
            add_line(borders, (sideways - rise * run.direction) / steepness, (run.across - width) / steepness, foot);
        }
    }
}
#endif

Stroke add_stroke(inout Borders borders, int object, ivec2 point, mat2 foot) {
    uvec2 segment = texelFetch(bvh_segments, object).rg;
    uint slot = texelFetch(bvh_owners, int(segment.x & ~PLAIN_END)).r;
    uvec4 style = texelFetch(bvh_styles, int(slot));
    float half_width = uintBitsToFloat(style.g);
    int place = int(style.b);
    Look look = look_at(place);
    mat2 lengths = mat2(1.0);
#ifdef SLOPES
    if (look.slope == tangent_slope) lengths = tangent_lengths(gradient);
    if (look.slope == thoeny_slope) half_width *= thoeny_width(gradient, forward.z);
#endif
    Run run = run_to(segment, point, lengths);
    foot = lengths * foot;
    float radius = pixel_radius(foot);
    float past = max(-dot(run.from_start, run.direction), dot(run.from_end, run.direction));
    bool near_bar = !run.is_dot && run.across <= half_width + radius && past <= longest_reach(look, half_width) + radius;
    bool near_dot = run.is_dot && length(run.from_start) <= 1.5 * half_width + radius;
    Stroke stroke = Stroke(slot, half_width > 0.0 && (near_bar || near_dot));
    if (!stroke.shows) return stroke;
    if (run.is_dot && look.cap == square_cap) add_unknown(borders);
    vec2 normal = vec2(-run.direction.y, run.direction.x) * (dot(run.from_start, vec2(-run.direction.y, run.direction.x)) < 0.0 ? -1.0 : 1.0);
    for (int i = 0; i < max(look.bands, 1); ++i) {
        float width = half_width;
        if (look.bands > 0) width *= uintBitsToFloat(texelFetch(bvh_looks, place + 1 + look.marks + i).r);
        if (run.is_dot) {
            add_circle(borders, run.from_start, width, foot);
            continue;
        }
        add_line(borders, normal, run.across - width, foot);
        if (!run.plain_start) add_end(borders, run, look, true, run.from_start, width, foot);
        if (!run.plain_end) add_end(borders, run, look, false, run.from_end, width, foot);
    }
#ifdef PATTERNS
    if (look.marks > 0) {
        add_marks(borders, run, look, place, half_width, foot);
        // Of corners and caps in a mark, more than that may show.
        if (past > -radius) add_unknown(borders);
    }
#endif
    return stroke;
}
#else
Stroke add_stroke(inout Borders borders, int segment, ivec2 point, mat2 foot) {
    ivec2 ends = ivec2(texelFetch(bvh_segments, segment).rg);
    ivec2 a = texelFetch(bvh_vertices, ends.x).rg, b = texelFetch(bvh_vertices, ends.y).rg;
    uint slot = texelFetch(bvh_owners, ends.x).r;
    float half_width = uintBitsToFloat(texelFetch(bvh_styles, int(slot)).g);
    float radius = pixel_radius(foot);
    float away = sqrt(distance2(point, a, b));
    Stroke stroke = Stroke(slot, half_width > 0.0 && away <= half_width + rounded * radius);
    if (!stroke.shows || away < half_width - rounded * radius) return stroke;
    vec2 along = vec2(b - a);
    float run = length(along);
    vec2 direction = along / max(run, 1.0);
    float t = dot(vec2(point - a), direction);
    float reach = half_extent(direction * foot) + 1e-6 * run + 1.0;
    if (run > 0.0 && t >= -reach && t <= run + reach)
        add_line(borders, vec2(-direction.y, direction.x), abs(exact_across(point, a, b)) - half_width, foot);
    if (t < reach) add_circle(borders, vec2(point - a), half_width, foot);
    if (t > run - reach) add_circle(borders, vec2(point - b), half_width, foot);
    return stroke;
}
#endif

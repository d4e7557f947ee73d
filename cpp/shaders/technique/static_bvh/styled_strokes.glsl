// Strokes with corners, caps, patterns, bands or slope corrections: which of a cell's segments cover a point.
//
//     before      start =========== end      after      vertices in the way of the line; `before` or `after`
//        o----------o                 o--------o        are the start or the end itself where there is a cap
#include "shared/stroke.glsl"
#include "technique/static_bvh/candidate.glsl"

#ifdef SLOPES
// Of the terrain at the pixel's centre; set before any walk.
vec2 gradient = vec2(0.0);
#endif

struct Look {
    uint corner;
    uint cap;
    uint slope;
    int marks;  // how many, and how many bands
    int bands;
    float limit;
    float period;
};

Look look_at(int place) {
    uvec4 header = texelFetch(bvh_looks, place);
    return Look(header.x >> LOOK_CORNER_SHIFT & LOOK_KIND_MASK, header.x >> LOOK_CAP_SHIFT & LOOK_KIND_MASK,
                header.x >> LOOK_SLOPE_SHIFT & LOOK_KIND_MASK, int(header.x >> LOOK_MARKS_SHIFT & LOOK_COUNT_MASK),
                int(header.x >> LOOK_BANDS_SHIFT & LOOK_COUNT_MASK), uintBitsToFloat(header.y),
                uintBitsToFloat(header.z));
}

// A segment as vectors to the point.
struct Run {
    vec2 from_start;
    vec2 from_end;
    vec2 direction;
    float across;
    vec2 incoming;  // of length 0 where the stroke begins
    vec2 outgoing;  // of length 0 where it ends
    bool plain_start;
    bool plain_end;
    bool is_dot;
    vec2 phases;  // of the start and the end, quanta
    float along;  // from the start to the foot of the point, as the pattern measures it
    float stretch;  // of such a length by the slope at the pixel
};

vec2 direction_of(mat2 lengths, ivec2 way) {
    vec2 v = lengths * vec2(way);
    return way == ivec2(0) ? vec2(0.0) : normalize(v);
}

Run run_to(uvec2 segment, ivec2 point, mat2 lengths) {
    ivec2 places = ivec2(segment & ~PLAIN_END);
    bvec2 plain = notEqual(segment & PLAIN_END, uvec2(0u));
    // As stored, so that the same segment the other way round is as near to the last digit.
    ivec2 a = texelFetch(bvh_vertices, places.x).rg, b = texelFetch(bvh_vertices, places.y).rg;
    ivec2 way = b - a;
    ivec2 size = max(abs(point - a), abs(way));
    vec2 level = direction_of(mat2(1.0), way);
    float across = max(size.x, size.y) < float_reach ? cross_product(level, vec2(point - a)) : exact_across(point, a, b);
    bool forward = places.x < places.y;
    int start = forward ? places.x : places.y, end = forward ? places.y : places.x;
    ivec2 from = forward ? a : b, to = forward ? b : a;
    Run run;
    run.from_start = lengths * vec2(point - from);
    run.from_end = lengths * vec2(point - to);
    run.direction = direction_of(lengths, to - from);
    // Areas grow by the determinant, and lengths along the segment by that of its direction.
    float stretch = max(length(lengths * level), 1e-30);
    run.across = abs(across) * determinant(lengths) / stretch;
    run.incoming = direction_of(lengths, from - texelFetch(bvh_vertices, start - 1).rg);
    run.outgoing = direction_of(lengths, texelFetch(bvh_vertices, end + 1).rg - to);
    run.plain_start = forward ? plain.x : plain.y;
    run.plain_end = forward ? plain.y : plain.x;
    run.is_dot = way == ivec2(0);
#ifdef PATTERNS
    run.phases = vec2(uintBitsToFloat(texelFetch(bvh_owners, start).g), uintBitsToFloat(texelFetch(bvh_owners, end).g));
    run.stretch = stretch;
#ifdef GROUND
    run.stretch /= uintBitsToFloat(texelFetch(bvh_owners, end).b);
#endif
    run.along = dot(run.from_start, run.direction) / run.stretch;
#endif
    return run;
}

// The least half widths at which the bar and what is at its start and its end cover the point.
vec3 reaches(Run run, Look look, float half_width) {
    if (run.is_dot) return vec3(out_of_reach, dot_reach(look.cap, run.from_start), out_of_reach);
    bvec2 is_cap = bvec2(run.incoming == vec2(0.0), run.outgoing == vec2(0.0));
    bvec2 is_plain = bvec2(run.plain_start, run.plain_end);
    // A quarter of a quantum is less than points are rounded by.
    bvec2 is_longer = bvec2(is_cap.x && !is_plain.x, is_cap.y && !is_plain.y);
    vec2 longer = look.cap == square_cap ? mix(vec2(0.25), vec2(half_width), is_longer) : vec2(0.25);
    float bar = bar_reach(run.from_start, run.from_end, run.direction, run.across, longer);
    float start = is_cap.x ? cap_reach(look.cap, run.from_start)
                           : corner_reach(look.corner, run.from_start, run.incoming, run.direction, look.limit);
    float end = is_cap.y ? cap_reach(look.cap, run.from_end)
                         : corner_reach(look.corner, run.from_end, run.direction, run.outgoing, look.limit);
    return vec3(bar, mix(vec2(start, end), vec2(out_of_reach), is_plain));
}

#ifdef PATTERNS
// The shares of the stroke's width that its pattern leaves of the same three, below 0 for nothing.
vec3 pattern_widths(Run run, Look look, int place) {
    vec3 phase = vec3(run.phases.x + run.along, run.phases);
    vec3 widths = vec3(look.marks > 0 ? -1.0 : 1.0);
    for (int i = 1; i <= look.marks; ++i) {
        vec4 mark = uintBitsToFloat(texelFetch(bvh_looks, place + i));
        for (int k = 0; k < 3; ++k) widths[k] = max(widths[k], mark_width(mark, pattern_phase(phase[k], look.period)));
    }
    return widths;
}
#endif

#ifdef THOENY
// The shares of the pixel that the bar and what is at the ends cover, the most of them; `pixel`: its width across the
// line and along.
float coverage_of(Run run, Look look, int place, vec3 reach, float half_width, vec2 pixel) {
    vec3 covered = vec3(0.0);
#ifdef PATTERNS
    for (int i = 1; i <= look.marks; ++i) {
        vec4 mark = uintBitsToFloat(texelFetch(bvh_looks, place + i));
        float phase = pattern_phase(run.phases.x + run.along, look.period);
        float nearest = mark_width(mark, clamp(phase, mark.x, mark.y));
        float share = thoeny_mark_coverage(mark.x, mark.y, look.period, phase, pixel.y);
        covered.x += share * thoeny_coverage(reach.x, half_width * nearest, pixel.x);
        for (int k = 1; k < 3; ++k) {
            float width = mark_width(mark, pattern_phase(run.phases[k - 1], look.period));
            if (width > 0.0) covered[k] = max(covered[k], thoeny_coverage(reach[k], half_width * width, pixel.x));
        }
    }
    if (look.marks > 0) return max(covered.x, max(covered.y, covered.z));
#endif
    return thoeny_coverage(min(reach.x, min(reach.y, reach.z)), half_width, pixel.x);
}

// Bands as lines of their own, each over the next wider one: what it adds to them is its share of the colour.
vec4 covered_color(Run run, Look look, int place, uint own, vec3 reach, float half_width, vec2 pixel) {
    vec4 straight = unpackUnorm4x8(own);
    vec4 color = straight;
    float narrower = 0.0;
    vec4 sum = vec4(0.0);
    int last = max(look.bands, 1);
    for (int i = 0; i < last; ++i) {
        float share = 1.0;
        if (look.bands > 0) {
            uvec2 band = texelFetch(bvh_looks, place + 1 + look.marks + i).rg;
            share = uintBitsToFloat(band.x);
            color = unpackUnorm4x8(band.y) * vec4(vec3(1.0), straight.a);
        }
        float coverage = coverage_of(run, look, place, reach, share * half_width, pixel);
        sum += max(coverage - narrower, 0.0) * vec4(color.rgb * color.a, color.a);
        narrower = max(narrower, coverage);
    }
    return sum;
}

Candidate candidate(int object, ivec2 point, mat2 foot) {
#else
Candidate candidate(int object, ivec2 point) {
#endif
    uvec2 segment = texelFetch(bvh_segments, object).rg;
    Candidate found;
    found.slot = texelFetch(bvh_owners, int(segment.x & ~PLAIN_END)).r;
    uvec4 style = texelFetch(bvh_styles, int(found.slot));
    found.rank = style.a;
    float half_width = uintBitsToFloat(style.g);
    Look look = look_at(int(style.b));
    mat2 lengths = mat2(1.0);
#ifdef SLOPES
    if (look.slope == tangent_slope) lengths = tangent_lengths(gradient);
    if (look.slope == thoeny_slope) half_width *= thoeny_width(gradient, forward.z);
#endif
    Run run = run_to(segment, point, lengths);
    vec3 reach = reaches(run, look, half_width);
#ifdef THOENY
    mat2 stretched = lengths * foot;
    vec2 along = run.is_dot ? vec2(1.0, 0.0) : run.direction;
    vec2 pixel = vec2(pixel_width(stretched, vec2(-along.y, along.x)), pixel_width(stretched, along));
    found.color = covered_color(run, look, int(style.b), style.r, reach, half_width, pixel);
    float nearest = min(reach.x, min(reach.y, reach.z));
    found.distance2 = nearest < out_of_reach ? nearest * nearest : out_of_reach;
    found.covers = half_width > 0.0 && found.color.a > 0.0;
#else
    vec3 limit = vec3(half_width);
#ifdef PATTERNS
    limit *= pattern_widths(run, look, int(style.b));
#endif
    vec3 covering = mix(vec3(out_of_reach), reach, lessThanEqual(reach, limit));
    float least = min(covering.x, min(covering.y, covering.z));
    found.covers = half_width > 0.0 && least < out_of_reach;
    found.distance2 = least < out_of_reach ? least * least : out_of_reach;
    found.across = least / half_width;
#endif
    return found;
}

#if defined(BANDS) && !defined(THOENY)
// The colour of a stroke at a place across it, straight alpha.
vec4 band_color(uint slot, float across) {
    uvec4 style = texelFetch(bvh_styles, int(slot));
    vec4 own = unpackUnorm4x8(style.r);
    Look look = look_at(int(style.b));
    int first = int(style.b) + 1 + look.marks;
    uint color = style.r;
    // From the outermost inwards.
    for (int i = look.bands - 1; i >= 0; --i) {
        uvec2 band = texelFetch(bvh_looks, first + i).rg;
        if (across <= uintBitsToFloat(band.x) || i == look.bands - 1) color = band.y;
    }
    vec4 found = unpackUnorm4x8(color);
    if (look.bands > 0) found.a *= own.a;
    return found;
}
#endif

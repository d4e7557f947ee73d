// How near a point is to the parts of a stroke, told by float vectors that lead to the point.
//
// Each function answers with the half width from which on its part covers the point, or with out_of_reach where
// none does. So a stroke of half width r covers it where the least of them is at most r; that divided by r is the
// place across the stroke, 0 at its middle and 1 at its border, which its colours follow.
//
//              outgoing
//                |       to the corner: `from` leads there from the vertex; the directions are those of the
//     ===========+       segments that come to it and go on from it, in the way of the line
//     incoming   |
//
// Corners after Zechmeister 2020, section 3.6; styles are numbered as in decalgl/vector/stroke.h.

const uint round_corner = 0u;
const uint miter_corner = 1u;
const uint bevel_corner = 2u;
const uint round_cap = 0u;
const uint butt_cap = 1u;
const uint square_cap = 2u;
const uint thoeny_slope = 1u;
const uint tangent_slope = 2u;

const float out_of_reach = 1e38;

float cross_product(vec2 a, vec2 b) {
    return a.x * b.y - a.y * b.x;
}

// Between a segment's ends, from which `from_a` and `from_b` lead; `across` from its line. `longer`: how far it
// goes on beyond either end, with a square cap a half width, else so little that rounding opens no gap.
float bar_reach(vec2 from_a, vec2 from_b, vec2 direction, float across, vec2 longer) {
    bool between = dot(from_a, direction) >= -longer.x && dot(from_b, direction) <= longer.y;
    return between ? abs(across) : out_of_reach;
}

// Whether a corner ends in a tip or a cut, and is no disc. `limit`: the cosine of the miter limit, the least angle
// between the two segments.
bool is_pointed(uint corner, vec2 incoming, vec2 outgoing, float limit) {
    // Right angles are sharper than a limit of 90 degrees by rounding alone. A way straight back has no tip.
    vec2 sum = incoming + outgoing;
    bool has_tip = dot(incoming, outgoing) >= -limit - 1e-6 && dot(sum, sum) > 1e-12;
    return corner == bevel_corner || (corner == miter_corner && has_tip);
}

float corner_reach(uint corner, vec2 from, vec2 incoming, vec2 outgoing, float limit) {
    bool in_gap = dot(from, incoming) >= 0.0 && dot(from, outgoing) <= 0.0;
    float reach = max(abs(cross_product(incoming, from)), abs(cross_product(outgoing, from)));
    if (corner == bevel_corner) {
        // The sine of the turn, from the difference or the sum, whichever is short. Nothing is left of a corner that goes
        // straight on, or straight back.
        vec2 bend = incoming - outgoing;
        float sine = abs(cross_product(incoming, dot(incoming, outgoing) > 0.0 ? bend : incoming + outgoing));
        reach = sine < 1e-7 ? out_of_reach : max(reach, dot(from, bend) / sine);
    }
    bool pointed = is_pointed(corner, incoming, outgoing, limit);
    return !pointed ? length(from) : in_gap ? reach : out_of_reach;
}

// Beside what the bar does.
float cap_reach(uint cap, vec2 from) {
    return cap == round_cap ? length(from) : out_of_reach;
}

// A part of one point.
float dot_reach(uint cap, vec2 from) {
    float square = max(abs(from.x), abs(from.y));
    return cap == round_cap ? length(from) : cap == square_cap ? square : out_of_reach;
}

// Where a length along a stroke lies in its pattern.
float pattern_phase(float along, float period) {
    return along - period * floor(along / period);
}

// The share of a stroke's width that a mark, (begin, end, begin width, end width), has at a phase; below 0 beside
// the mark.
float mark_width(vec4 mark, float phase) {
    float share = clamp((phase - mark.x) / (mark.y - mark.x), 0.0, 1.0);
    return phase >= mark.x && phase <= mark.y ? mix(mark.z, mark.w, share) : -1.0;
}

// Turns vectors on the map into such of the tangent plane of a slope, as long as they are there.
mat2 tangent_lengths(vec2 gradient) {
    float steepness = dot(gradient, gradient);
    float stretch = steepness > 0.0 ? (sqrt(1.0 + steepness) - 1.0) / steepness : 0.0;
    return mat2(1.0) + stretch * outerProduct(gradient, gradient);
}

// What Thöny et al. 2018, section 3.3, multiply widths by: narrower on slopes, the less the more steeply the
// camera looks down. `forward_z`: of its view direction.
float thoeny_width(vec2 gradient, float forward_z) {
    return mix(inversesqrt(1.0 + dot(gradient, gradient)), 1.0, clamp(-forward_z, 0.0, 1.0));
}

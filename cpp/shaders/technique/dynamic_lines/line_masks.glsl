// Which samples of a pixel a stroke on the screen covers; all places in pixels from the pixel's centre.
//
// A bar is four half planes of the table, its round ends discs of which only what lies beyond the bar counts: where the
// next bar begins, the two share the samples out between them.
#include "shared/half_planes.glsl"
#include "shared/stroke.glsl"

const float half_diagonal = 0.7072;

// Where border and table agree on a round end: the table's half planes are straight.
const float least_curved = 1.0;  // radius

uvec2 disc_mask(vec2 centre, float radius) {
    float distance = length(centre);
    uvec2 mask = no_samples;
    if (distance < radius + half_diagonal) {
        if (radius >= least_curved) {
            // The half plane at the nearest point of the border, moved in by what the arc falls back within a pixel.
            vec2 inwards = centre / max(distance, 1e-6);
            mask = samples_beyond(direction_of(inwards), radius - distance - 1.0 / (24.0 * radius));
        } else {
            int i = 0;
            do {
                vec2 apart = sample_offsets[i] - centre;
                mask |= sample_if(dot(apart, apart) <= radius * radius, i);
            } while (++i < sample_count);
        }
    }
    return mask;
}

// Samples that lie to the one side of a line through a point.
uvec2 beyond_line(vec2 point, vec2 inwards) {
    return samples_beyond(direction_of(inwards), -dot(point, inwards));
}

// What is left between two bars at the vertex where they meet.
uvec2 wedge_mask(vec2 at, vec2 incoming, vec2 outgoing) {
    return beyond_line(at, incoming) & beyond_line(at, -outgoing);
}

struct Stroke {
    vec2 from;
    vec2 to;
    vec2 direction;
    float half_width;
};

// Between the ends, lengthened by so much before and behind.
uvec2 bar_mask(Stroke stroke, vec2 longer) {
    Direction across = direction_of(vec2(-stroke.direction.y, stroke.direction.x));
    float offset = cross_product(stroke.direction, -stroke.from);
    uvec2 mask = samples_beyond(across, stroke.half_width + offset) & ~samples_beyond(across, offset - stroke.half_width);
    Direction along = direction_of(stroke.direction);
    mask &= samples_beyond(along, longer.x - dot(stroke.from, stroke.direction));
    return mask & ~samples_beyond(along, -longer.y - dot(stroke.to, stroke.direction));
}

// Strokes by their coverage of the pixel in place of points of it (Thöny et al. 2018, section 3.5), for pixels of few cells.
//
// Looks into all cells that the pixel reaches into. What covers any of it is laid over each other by its coverage, of more
// than eight decals the topmost: of a stroke what its nearest part covers, with patterns and bands as lines of their own; of
// a fill the share of the samples.
#include "shared/thoeny_coverage.glsl"
#include "technique/static_decals/area.glsl"

const int most_decals = 8;

// Topmost first.
struct Layers {
    uint slots[most_decals];
    vec4 colors[most_decals];  // of strokes: premultiplied, by their coverage
    uvec2 masks[most_decals];   // samples, of fills and of cells that a stroke covers
};

void keep(inout Layers layers, uint slot, vec4 color, uvec2 mask) {
    int at = most_decals;
    for (int i = most_decals - 1; i >= 0; --i)
        if (slot <= layers.slots[i]) at = i;
    if (at == most_decals) return;
    bool again = layers.slots[at] == slot;
    for (int i = most_decals - 1; i > at; --i) {
        if (again) continue;
        layers.slots[i] = layers.slots[i - 1];
        layers.colors[i] = layers.colors[i - 1];
        layers.masks[i] = layers.masks[i - 1];
    }
    bool more = !again || color.a > layers.colors[at].a;
    layers.slots[at] = slot;
    layers.masks[at] = again ? layers.masks[at] | mask : mask;
    layers.colors[at] = more ? color : layers.colors[at];
}

// The part of a stroke that is nearest to the pixel's centre.
struct Nearest {
    float reach;  // the half width at which it would cover the centre
    vec2 along;   // its direction
    float periods;
};

Nearest nearer(Nearest best, Group group) {
    vec2 from = group.before, goes = group.before - group.from;
    float run = length(goes);
    bool joined = has(group.style, STYLE_JOINED);
    float t = run > 0.0 ? dot(from, goes) / run : 0.0;
    float inside = clamp(t, 0.0, run);
    float reach = run > 0.0 ? length(from - inside * (goes / run)) : length(from);
    if (joined && run > 0.0 && t != inside) reach = out_of_reach;
    if (joined && run > 0.0 && group.pen_before.has_came)
        reach = min(reach, joint_reach(group.style, from, group.pen_before.came, goes));
    // A point where the pen is put down has no direction, and the edge from there is as near.
    if (run > 0.0 ? reach > best.reach : reach >= best.reach) return best;
    float along_map = run > 0.0 ? inside / run * group.run : 0.0;
    return Nearest(reach, run > 0.0 ? goes / run : best.along,
                   group.pen_before.periods + along_map * group.style.periods_per_unit);
}

// Each mark of the pattern as a line of its own, as long as the share of the pixel that it takes up.
float covered_share(Style style, Nearest part, float half_width, vec2 pixel) {
#ifdef PATTERNS
    if (has(style, STYLE_PATTERN)) {
        float covered = 0.0;
        int i = 0;
        do {
            vec4 mark = record_texel(style.record + 1 + i);
            float phase = fract(part.periods);
            float share = clamp((clamp(phase, mark.x, mark.y) - mark.x) / max(mark.y - mark.x, 1e-9), 0.0, 1.0);
            float taken = thoeny_mark_coverage(mark.x, mark.y, 1.0, phase, max(pixel.y * style.periods_per_unit, 1e-9));
            covered += taken * thoeny_coverage(part.reach, half_width * mix(mark.z, mark.w, share), pixel.x);
        } while (++i < mark_count(style));
        return min(covered, 1.0);
    }
#endif
    return thoeny_coverage(part.reach, half_width, pixel.x);
}

// Bands as lines of their own, each over the next wider one.
vec4 covered_color(Style style, uint slot, Nearest part, mat2 foot) {
    vec2 pixel = vec2(pixel_width(foot, vec2(-part.along.y, part.along.x)), pixel_width(foot, part.along));
    vec4 straight = color_of(slot);
    int bands = has(style, STYLE_BANDS) ? int(style.counts >> BANDS_SHIFT) : 1;
    float narrower = 0.0;
    vec4 sum = vec4(0.0);
    int i = 0;
    do {
        float share = 1.0;
        vec4 color = straight;
        if (has(style, STYLE_BANDS)) {
            uvec4 band = texelFetch(style_records, style.record + 1 + mark_count(style) + i);
            share = uintBitsToFloat(band.x);
            color = unpackUnorm4x8(band.y) * vec4(vec3(1.0), straight.a);
        }
        float coverage = covered_share(style, part, share * style.half_width, pixel);
        sum += max(coverage - narrower, 0.0) * vec4(color.rgb * color.a, color.a);
        narrower = max(narrower, coverage);
    } while (++i < bands);
    return sum;
}

void end_group(inout Layers layers, inout uvec2 open, Group group, Nearest part, Cell cell, vec2 local, mat2 foot,
               uvec2 inside) {
    if (group.slot == SLOT_MASK) return;
    if (group.clip) {
        open = group.covered;
        return;
    }
    float seen = float(count_of(open & inside)) / max(float(count_of(inside)), 1.0);
    if (open == all_samples) seen = 1.0;
    if (group.line) {
        uvec2 mask = group.covered & inside & open;
        vec4 color = seen * covered_color(group.style, group.slot, part, group.foot);
        if (color.a > 0.0 || !is_empty(mask)) keep(layers, group.slot, color, mask);
    } else {
        uvec2 mask = shown_samples(group, cell, local, foot, group.covered & inside);
        if (!is_empty(mask)) keep(layers, group.slot, vec4(0.0), mask);
    }
    open = all_samples;
}

void look_into(inout Layers layers, Cell cell, vec2 local, mat2 foot, uvec2 inside) {
    float bias = bias_of(cell.bits);
    int at = 4 * int(cell.entry >> COUNT_BITS);
    uint count = cell.entry & COUNT_ESCAPE;
    int end = count == COUNT_ESCAPE ? 0x7FFFFFFF : at + 4 * int(count);
    uvec2 open = all_samples;
    Group group = group_of(SLOT_MASK, bias, local, foot);
    Nearest part = Nearest(out_of_reach, vec2(1.0, 0.0), 0.0);
    bool ended = false;
    do {
        uint word = at < end ? texel_at(at >> 2)[at & 3] : LIST_END;
        ++at;
        if (is_header(word)) {
            end_group(layers, open, group, part, cell, local, foot, inside);
            group = group_of(word, bias, local, foot);
            part = Nearest(out_of_reach, vec2(1.0, 0.0), 0.0);
            ended = word == LIST_END;
        } else {
            bool is_pattern = group.pen.awaited > 0;
            bool dot_of_joined = starts_edge(word) && has(group.style, STYLE_JOINED);
            uint alike = read_point(group, word);
            if (!group.line) group.covered ^= alike == for_each ? crossing_mask(crossing_of(group, group.before, group.from)) : uvec2(alike);
            else if (!is_pattern && !dot_of_joined) part = nearer(part, group);
        }
    } while (!ended);
}

vec4 composite_thoeny(LatticePosition centre, mat2 foot) {
    Layers layers;
    for (int i = 0; i < most_decals; ++i) {
        layers.slots[i] = no_slot;
        layers.colors[i] = vec4(0.0);
        layers.masks[i] = no_samples;
    }
    vec2 reach = 0.5 * (abs(foot[0]) + abs(foot[1]));
    ivec2 low = centre.quantum + ivec2(floor(centre.fraction - reach));
    ivec2 high = centre.quantum + ivec2(floor(centre.fraction + reach));
    int bits = min(min(cell_at(low).bits, cell_at(high).bits),
                   min(cell_at(ivec2(low.x, high.y)).bits, cell_at(ivec2(high.x, low.y)).bits));
    ivec2 place = low;
    do {
        Cell cell = cell_at(place);
        vec2 local = vec2(centre.quantum - cell.corner) + centre.fraction;
        look_into(layers, cell, local, foot, samples_in_cell(local, foot, float(1 << cell.bits)));
        bool row_ends = (place.x >> bits) >= (high.x >> bits);
        place = row_ends ? ivec2(low.x, ((place.y >> bits) + 1) << bits) : ivec2(((place.x >> bits) + 1) << bits, place.y);
    } while ((place.y >> bits) <= (high.y >> bits));
    vec4 sum = vec4(0.0);
    for (int i = 0; i < most_decals; ++i) {
        vec4 color = layers.colors[i];
        vec4 straight = is_empty(layers.masks[i]) ? vec4(0.0) : color_of(layers.slots[i]);
        float sampled = straight.a * float(count_of(layers.masks[i])) / float(sample_count);
        sum += (1.0 - sum.a) * (sampled > color.a ? sampled * vec4(straight.rgb, 1.0) : color);
    }
    return sum;
}

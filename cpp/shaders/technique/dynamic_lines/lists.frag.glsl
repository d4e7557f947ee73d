// The lines of a pixel out of its list (lists_buffers.glsl), laid over each other from the front (Zechmeister 2020,
// section 4.4.2).
//
// UNION   all that is shown looks the same and is opaque: any entry tells
// SIDES   inset and offset outlines: whether they are shown is told by all of a line's entries
// IDS     1 + slot of the topmost line; lists need not be sorted
#include "technique/dynamic_lines/line_entry.glsl"

uniform usamplerBuffer list_heads;
uniform usamplerBuffer list_next;
uniform usamplerBuffer list_entries;
#ifdef SIDES
uniform usamplerBuffer list_asides;
#endif
uniform int picture_width;  // of the rectangle that is drawn

const uint list_end = 0xFFFFFFFFu;

#ifdef IDS
layout(location = 0) out uint id;
#else
layout(location = 0) out vec4 color;  // premultiplied
#endif

uint first_entry() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    return texelFetch(list_heads, pixel.y * picture_width + pixel.x).r;
}

uint entry_after(uint entry) {
    return texelFetch(list_next, int(entry)).r;
}

// Which line, and its colour.
uvec2 entry_at(uint entry) {
    return texelFetch(list_entries, int(entry)).rg;
}

uint aside_at(uint entry) {
#ifdef SIDES
    return texelFetch(list_asides, int(entry)).r;
#else
    return shown_anyway;
#endif
}

#ifdef IDS

// 1 + slot of the topmost line that is shown, or 0: a band of no colour hides those of its line that lie farther out.
uint topmost_id(uint first) {
    uvec2 below = uvec2(list_end, 0u), best;
    Asides asides = no_asides;
    bool found, hides = false;
    do {
        uint entry = first;
        best = uvec2(0u);
        found = false;
        do {
            uvec2 line = entry_at(entry);
            bool is_hidden = hides && is_same_line(line.x, below.x);
            bool is_next = line.x < below.x && !is_hidden && (!found || line.x > best.x);
            if (is_next) asides = no_asides;
            best = is_next ? line : best;
            found = found || is_next;
            if (found && line.x == best.x) add_aside(asides, aside_at(entry));
            entry = entry_after(entry);
        } while (entry != list_end);
        hides = asides.covered;
        below = best;
    } while (found && !(is_shown(asides) && unpackUnorm4x8(best.y).a > 0.0));
    return found ? slot_of_entry(best.x) + 1u : 0u;
}

void main() {
    uint entry = first_entry();
    id = 0u;
    if (entry != list_end) id = topmost_id(entry);
}

#else

// Entries of a line and band follow each other. A line covers a pixel once, however many of its segments and bands do.
vec4 composite(uint entry) {
    vec4 sum = vec4(0.0);
    uvec2 line = entry_at(entry);
    Asides asides = no_asides;
    bool taken = false;  // by a band of the same line that lies farther in
    do {
        add_aside(asides, aside_at(entry));
        entry = entry_after(entry);
        uvec2 after = uvec2(list_end, 0u);
        if (entry != list_end) after = entry_at(entry);
        if (after.x != line.x) {
            vec4 straight = unpackUnorm4x8(line.y);
            float weight = is_shown(asides) && !taken ? (1.0 - sum.a) * straight.a : 0.0;
            sum += weight * vec4(straight.rgb, 1.0);
            taken = is_same_line(after.x, line.x) && (taken || asides.covered);
            asides = no_asides;
            line = after;
        }
    } while (entry != list_end && sum.a < 0.999);
    return sum;
}

void main() {
    uint entry = first_entry();
    color = vec4(0.0);
#ifdef UNION
    if (entry != list_end) color = vec4(unpackUnorm4x8(entry_at(entry).y).rgb, 1.0);
#else
    if (entry != list_end) color = composite(entry);
#endif
}

#endif

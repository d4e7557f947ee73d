// The lines of a pixel out of its list, laid over each other from the front (Zechmeister 2020, section 4.4.2).
//
// UNION   all that is shown looks the same and is opaque: any entry tells
// IDS     1 + slot of the topmost line; lists need not be sorted
#include "technique/dynamic_lines/lists_buffers.glsl"

#ifdef IDS
layout(location = 0) out uint id;
#else
layout(location = 0) out vec4 color;  // premultiplied
#endif

#ifdef IDS

uint topmost(uint entry) {
    uint slot = 0u;
    do {
        slot = max(slot, entries[entry].x + 1u);
        entry = next[entry];
    } while (entry != list_end);
    return slot;
}

void main() {
    uint entry = heads[list_of(ivec2(gl_FragCoord.xy))];
    id = 0u;
    if (entry != list_end) id = topmost(entry);
}

#else

vec4 composite(uint entry) {
    vec4 sum = vec4(0.0);
    uint slot = list_end;
    do {
        uvec2 line = entries[entry];
        vec4 straight = unpackUnorm4x8(line.y);
        // A line covers a pixel once, however many of its segments do.
        float weight = line.x == slot ? 0.0 : (1.0 - sum.a) * straight.a;
        sum += weight * vec4(straight.rgb, 1.0);
        slot = line.x;
        entry = next[entry];
    } while (entry != list_end && sum.a < 0.999);
    return sum;
}

void main() {
    uint entry = heads[list_of(ivec2(gl_FragCoord.xy))];
    color = vec4(0.0);
#ifdef UNION
    if (entry != list_end) color = vec4(unpackUnorm4x8(entries[entry].y).rgb, 1.0);
#else
    if (entry != list_end) color = composite(entry);
#endif
}

#endif

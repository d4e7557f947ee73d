// The lines of a pixel out of its list (lists_buffers.glsl), laid over each other from the front (Zechmeister 2020,
// section 4.4.2).
//
// UNION   all that is shown looks the same and is opaque: any entry tells
// IDS     1 + slot of the topmost line; lists need not be sorted
uniform usamplerBuffer list_heads;
uniform usamplerBuffer list_next;
uniform usamplerBuffer list_entries;
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

// Slot and colour.
uvec2 entry_at(uint entry) {
    return texelFetch(list_entries, int(entry)).rg;
}

#ifdef IDS

uint topmost(uint entry) {
    uint slot = 0u;
    do {
        slot = max(slot, entry_at(entry).x + 1u);
        entry = entry_after(entry);
    } while (entry != list_end);
    return slot;
}

void main() {
    uint entry = first_entry();
    id = 0u;
    if (entry != list_end) id = topmost(entry);
}

#else

vec4 composite(uint entry) {
    vec4 sum = vec4(0.0);
    uint slot = list_end;
    do {
        uvec2 line = entry_at(entry);
        vec4 straight = unpackUnorm4x8(line.y);
        // A line covers a pixel once, however many of its segments do.
        float weight = line.x == slot ? 0.0 : (1.0 - sum.a) * straight.a;
        sum += weight * vec4(straight.rgb, 1.0);
        slot = line.x;
        entry = entry_after(entry);
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

// One point in the cells of a view: down to its cell, and along that cell's list (cells_layout.h).
#include "technique/loops/cells_layout.h"
#include "shared/lattice_point.glsl"

uniform usamplerBuffer bucket_entries;
uniform usamplerBuffer cell_entries;
uniform usamplerBuffer cell_texels;
uniform usamplerBuffer loops_styles;  // colour, bits of the half width in quanta
uniform ivec2 grid_corner;  // of the first bucket, in quanta
uniform ivec2 grid_size;    // buckets
uniform int bucket_bits;    // a bucket is 2^bucket_bits quanta wide

const uint no_slot = 0xFFFFFFFFu;

struct Cell {
    int list;    // its first texel
    vec2 local;  // the point, from the cell's corner
    float size;
};

Cell cell_at(ivec2 point) {
    ivec2 offset = point - grid_corner;
    ivec2 bucket = offset >> bucket_bits;
    bool inside = all(greaterThanEqual(bucket, ivec2(0))) && all(lessThan(bucket, grid_size));
    uint entry = texelFetch(bucket_entries, inside ? bucket.y * grid_size.x + bucket.x : 0).r;
    int level = int(entry & ((1u << CELL_LEVEL_BITS) - 1u));
    int bits = bucket_bits - level;
    ivec2 place = (offset & ((1 << bucket_bits) - 1)) >> bits;
    uint list = texelFetch(cell_entries, int(entry >> CELL_LEVEL_BITS) + (place.y << level | place.x)).r;
    return Cell(inside ? int(list) : 0, vec2(offset & ((1 << bits) - 1)), float(1 << bits));
}

// Whether the way from the cell's corner to a point crosses an edge: up the left border, where the edge may begin, or
// along the point's row.
bool crosses(vec4 edge, vec2 point) {
    bool on_border = edge.x == 0.0 && edge.y > 0.0 && edge.y <= point.y;
    bool rises = edge.y <= edge.w;
    vec2 low = rises ? edge.xy : edge.zw, high = rises ? edge.zw : edge.xy;
    precise vec2 to_point = point - low, along = high - low;
    bool on_row = low.y <= point.y && point.y < high.y && to_point.x * along.y >= to_point.y * along.x;
    return on_border != on_row;
}

// Squared, from the point to a segment.
float distance2(vec4 edge, vec2 point) {
    vec2 from = point - edge.xy, along = edge.zw - edge.xy;
    vec2 away = from - along * clamp(dot(from, along) / max(dot(along, along), 1.0), 0.0, 1.0);
    return dot(away, away);
}

vec4 color_of(uint slot) {
    return unpackUnorm4x8(texelFetch(loops_styles, int(slot)).r);
}

struct Found {
    vec4 sum;   // premultiplied
    uint seen;  // the topmost slot that shows
    int edges;  // that were looked at
};

Found walk(ivec2 point) {
    Cell cell = cell_at(point);
    Found found = Found(vec4(0.0), no_slot, 0);
    int place = cell.list;
    bool goes_on;
    do {
        uvec4 header = texelFetch(cell_texels, place++);
        int end = place + int(header.x & CELL_EDGES);
        bool inside = (header.x & CELL_INSIDE) != 0u;
        bool stroke = (header.x & CELL_STROKE) != 0u;
        float half_width = uintBitsToFloat(header.z);
        found.edges += end - place;
        // At its end, since some drivers go through a body once more for a test at its beginning.
        do {
            vec4 edge = uintBitsToFloat(texelFetch(cell_texels, place));
            bool is_edge = place < end;
#if defined(FILLS) && defined(STROKES)
            bool crossed = !stroke && crosses(edge, cell.local);
            bool hit = stroke && distance2(edge, cell.local) <= half_width * half_width;
            inside = is_edge ? (inside || hit) != crossed : inside;
#elif defined(STROKES)
            inside = inside || (is_edge && distance2(edge, cell.local) <= half_width * half_width);
#else
            inside = inside != (is_edge && crosses(edge, cell.local));
#endif
            ++place;
        } while (place < end);
        place = end;
        vec4 color = color_of(header.y);
        if (inside && color.a > 0.0) {
            if (found.seen == no_slot) found.seen = header.y;
            found.sum += (1.0 - found.sum.a) * vec4(color.rgb * color.a, color.a);
        }
#if defined(TESTED) || defined(ACTIVE)
        bool done = false;
#elif defined(IDS)
        bool done = found.seen != no_slot;
#else
        bool done = found.sum.a >= 0.999;
#endif
        goes_on = !done && (header.x & CELL_LAST) == 0u;
    } while (goes_on);
    return found;
}

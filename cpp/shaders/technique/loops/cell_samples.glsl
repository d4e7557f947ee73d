// The samples of a pixel's area, cell by cell: those in one cell walk its list together, a bit each.
#include "shared/sample_offsets.glsl"

// A bit for each of 32 samples.
#define SAMPLE_MASK uint
bool is_empty(uint samples) {
    return samples == 0u;
}
int count_of(uint samples) {
    return bitCount(samples);
}
bool has_sample(uint samples, int index) {
    return (samples >> index & 1u) != 0u;
}
#include "shared/composed_samples.glsl"

uniform float quantum;  // metres, a power of two

// Which of 32 points cross an edge on their ways, or lie on a stroke. `place`: where the pixel's centre is in the cell.
uint hits(vec4 edge, bool stroke, float half_width, vec2 place, mat2 foot) {
    uint found = 0u;
    for (int i = 0; i < sample_count; ++i) {
        vec2 point = place + foot * sample_offsets[i];
#if defined(FILLS) && defined(STROKES)
        bool hit = stroke ? distance2(edge, point) <= half_width * half_width : crosses(edge, point);
#elif defined(STROKES)
        bool hit = distance2(edge, point) <= half_width * half_width;
#else
        bool hit = crosses(edge, point);
#endif
        found |= uint(hit) << i;
    }
    return found;
}

// The sum of the colours that the samples `open` see.
vec4 walk_together(Cell cell, vec2 place, mat2 foot, uint open) {
    Samples samples = samples_of(open);
    int texel = cell.list;
    bool goes_on;
    do {
        uvec4 header = texelFetch(cell_texels, texel++);
        int end = texel + int(header.x & CELL_EDGES);
        bool stroke = (header.x & CELL_STROKE) != 0u;
        uint inside = (header.x & CELL_INSIDE) != 0u ? 0xFFFFFFFFu : 0u;
        do {
            vec4 edge = uintBitsToFloat(texelFetch(cell_texels, texel));
            uint found = texel < end ? hits(edge, stroke, uintBitsToFloat(header.z), place, foot) : 0u;
            inside = stroke ? inside | found : inside ^ found;
            ++texel;
        } while (texel < end);
        texel = end;
        vec4 color = color_of(header.y);
        lay_under(samples, color.a > 0.0 ? inside : 0u, color);
        goes_on = samples.open != 0u && (header.x & CELL_LAST) == 0u;
    } while (goes_on);
    return samples.sum;
}

// The mean over the pixel's area; `foot`: quanta for a pixel to the right and up.
vec4 mean_of_samples(Position position, mat2 foot) {
    vec4 sum = vec4(0.0);
    uint left = 0xFFFFFFFFu;
    do {
        int first = findLSB(left);
        vec2 offset = foot * sample_offsets[first];
        Cell cell = cell_at(lattice_point(position, offset * quantum));
        vec2 place = cell.local - offset;
        uint within = 0u;
        for (int i = 0; i < sample_count; ++i) {
            vec2 point = place + foot * sample_offsets[i];
            bool is_in = all(greaterThanEqual(point, vec2(0.0))) && all(lessThan(point, vec2(cell.size)));
            within |= uint(is_in) << i;
        }
        within = (within | 1u << first) & left;
        sum += walk_together(cell, place, foot, within);
        left &= ~within;
    } while (left != 0u);
    return sum / float(sample_count);
}

// Which class a pixel is of (area_classes.h), and its colour where no border of a decal passes through it.
//
// One walk through the cell that the whole pixel lies in: an edge decides for all samples alike, or the pixel
// is left to the pass that takes each by itself.
#include "technique/static_decals/area_classes.h"
#include "technique/static_decals/area.glsl"
#ifdef LEVELS
#include "technique/static_decals/levels.glsl"
#endif

struct Classed {
    float kind;
    vec4 color;  // premultiplied
};

// Composes what ends, and says whether the pixel is still alike all over.
bool add_alike(inout vec4 sum, inout bool open, Group group) {
    bool covered = !is_empty(group.covered) && open;
#ifdef STYLES
    if (group.clip) {
        open = !is_empty(group.covered);
        return true;
    }
    open = true;
    if (covered && has(group.style, STYLE_HATCH)) return false;
#endif
    vec4 straight = color_of(group.slot);
    float weight = covered ? (1.0 - sum.a) * straight.a : 0.0;
    sum += weight * vec4(straight.rgb, 1.0);
    return true;
}

// `local`: the pixel's centre in quanta from the cell's corner.
Classed classed_cell(Cell cell, vec2 local, mat2 foot) {
    vec4 sum = vec4(0.0);
    bool open = true;
    float bias = bias_of(cell.bits);
    int at = 4 * int(cell.entry >> COUNT_BITS);
    uint count = cell.entry & COUNT_ESCAPE;
    int end = count == COUNT_ESCAPE ? 0x7FFFFFFF : at + 4 * int(count);
    Group group = group_of(0u, bias, local, foot);
    bool alike = true, ended = false;
    do {
        uint word = at < end ? texel_at(at >> 2)[at & 3] : LIST_END;
        ++at;
        if (is_header(word)) {
            alike = add_alike(sum, open, group);
#ifndef PARTS
            // A point without an edge is a disc.
            alike = alike && is_empty(group.beyond);
#endif
            group = group_of(word, bias, local, foot);
            ended = word == LIST_END || sum.a >= 0.999;
        } else {
            uint mask = read_point(group, word);
            alike = mask != for_each;
            if (alike) group.covered = is_stroke(group) ? group.covered | uvec2(mask) : group.covered ^ uvec2(mask);
        }
    } while (alike && !ended);
    return Classed(alike ? CLASS_DONE : CLASS_CELLS, sum);
}

bool is_within_cell(vec2 local, mat2 foot, float size) {
    vec2 reach = 0.5 * (abs(foot[0]) + abs(foot[1]));
    return all(greaterThanEqual(local, reach)) && all(lessThanEqual(local + reach, vec2(size)));
}

Classed classed(LatticePosition centre, mat2 foot) {
#ifdef THOENY
    const float cells_across = most_cells_looked_into;
#else
    const float cells_across = most_cells_across;
#endif
    Cell cell = cell_at(centre.quantum);
    vec2 local = vec2(centre.quantum - cell.corner) + centre.fraction;
    float size = float(1 << cell.bits);
    float kind = CLASS_DONE;
    if (!is_within_cell(local, foot, size)) kind = CLASS_CELLS;
    if (max(length(foot[0]), length(foot[1])) > cells_across * size) kind = CLASS_POINTS;
    bool from_levels = false;
#ifdef LEVELS
    from_levels = spans_texels(foot);
#endif
    if (kind != CLASS_DONE || from_levels) cell.entry = EMPTY_LIST;
    Classed result = classed_cell(cell, local, foot);
    if (kind != CLASS_DONE) result.kind = kind;
#ifdef LEVELS
    if (from_levels) result = Classed(CLASS_DONE, mean_of_levels(centre, foot));
#endif
    return result;
}

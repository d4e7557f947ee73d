// The borders of a group's decals in a pixel (borders.glsl).
#include "technique/static_bvh/borders.glsl"
#if defined(RINGS) || defined(BOTH)
#include "technique/static_bvh/fill_borders.glsl"
#endif
#ifndef RINGS
#include "technique/static_bvh/stroke_borders.glsl"
#endif
#ifdef FAR
#include "technique/static_bvh/far_borders.glsl"
#endif

// A pixel of more cells is taken to have some, and searched only around a place where one passes.
const int most_cells = FAR_CELLS;
// Objects and cells that are looked at: until one is found, and at the least where a nearer one may follow. Of very many
// borders none is worth a long search, as samples that follow any of them see the others as well.
const int most_steps = 4096;
const int least_steps = 256;

// What the fills that cover all of the pixel's part in a cell add up to: equal in all parts where no border is between.
uint signature_of(uint slot) {
    return (slot + 1u) * 2654435761u;
}

#if defined(RINGS) || defined(BOTH)
void add_fill(inout Borders borders, inout uint signature, uvec4 exterior, ivec2 point, ivec4 part, mat2 foot) {
#ifdef HIDDEN
    if (texelFetch(bvh_styles, int(exterior.y)).r >> 24 == 0u) return;
#endif
    uint inside = add_exterior(borders, exterior, point, part, foot);
    if (inside == all_probes) signature += signature_of(exterior.y);
#ifdef HATCHES
    if (inside != 0u) add_hatch(borders, int(texelFetch(bvh_styles, int(exterior.y)).b), point, foot);
#endif
}
#endif

#ifdef RINGS
void add_object(inout Borders borders, inout uint signature, int object, ivec2 point, ivec4 part, mat2 foot) {
    add_fill(borders, signature, texelFetch(bvh_exteriors, object), point, part, foot);
}
#elif defined(BOTH)
void add_object(inout Borders borders, inout uint signature, int object, ivec2 point, ivec4 part, mat2 foot) {
    uvec2 kind = texelFetch(bvh_objects, object).rg;
    bool is_stroke = (kind.x & STROKE_OBJECT) != 0u;
    uint place = is_stroke ? kind.y : kind.x;
    if (is_stroke) {
        Stroke stroke = add_stroke(borders, int(kind.x & ~STROKE_OBJECT), point, foot);
#if defined(INSET) || defined(OFFSET)
        if (!stroke.shows) place = NO_EXTERIOR;
#else
        place = NO_EXTERIOR;
#endif
    }
    if (place == NO_EXTERIOR) return;
    uvec4 exterior = texelFetch(bvh_exteriors, int(place));
    if (is_stroke) {
        add_exterior(borders, exterior, point, part, foot);
    } else {
        add_fill(borders, signature, exterior, point, part, foot);
    }
}
#else
#ifdef NEAREST
uint seen_slot = NO_SLOT;
#endif
void add_object(inout Borders borders, inout uint signature, int object, ivec2 point, ivec4 part, mat2 foot) {
    Stroke stroke = add_stroke(borders, object, point, foot);
#ifdef NEAREST
    // Between two strokes there is a border where they are equally near.
    if (stroke.shows && seen_slot != NO_SLOT && seen_slot != stroke.slot) add_unknown(borders);
    if (stroke.shows) seen_slot = stroke.slot;
#endif
}
#endif

// `foot`: the vectors for one pixel right and up, in quanta.
Borders find_borders(ivec2 point, mat2 foot) {
    Borders borders = Borders(no_border, vec2(0.0));
    Search search = search_around(point, half_pixel(foot));
    // Beyond the grid there is nothing.
    if (any(lessThan(search.box.zw, grid_box.xy)) || any(greaterThan(search.box.xy, grid_box.zw))) return borders;
#if !defined(RINGS) && !defined(BOTH)
    bool cut_by_grid = false;
#else
    bool cut_by_grid = any(lessThan(search.box.xy, grid_box.xy)) || any(greaterThan(search.box.zw, grid_box.zw));
#endif
    bool is_far = cells_in(search) > most_cells;
#ifdef FAR
    ivec2 place = place_at_border(point, foot, is_far);
    if (is_far) search = search_around(place, ivec2(1));
#endif
    if (is_far) add_unknown(borders);
    uint first_signature = 0u;
    uint signature = 0u;
    bool is_first = true, ended = false;
    int steps = 0;
    do {
        ivec2 corner = grid_box.xy + search.place * cell_size;
        ivec4 part = ivec4(max(search.box.xy, corner), min(search.box.zw, corner + cell_size - 1));
        int object = next_in_cell(search);
        if (object >= 0) {
            add_object(borders, signature, object, point, part, foot);
        } else if (search.node == 0u) {
            if (is_first) first_signature = signature;
            is_first = false;
            if (signature != first_signature || (cut_by_grid && signature != 0u)) add_unknown(borders);
            signature = 0u;
            ended = !next_cell(search);
        }
        ++steps;
    } while (!ended && steps < (borders.ratio < 1.0 ? least_steps : most_steps));
    // Mesa's software rasteriser ends all loops after 65,535 turns of them; then too there may be more.
    if (!ended) add_unknown(borders);
    return borders;
}

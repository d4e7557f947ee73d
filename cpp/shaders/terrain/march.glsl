// Where a ray meets the terrain: a walk over the cells below it, on the surface that is drawn but for its seams.
//
// In a cell the surface is two triangles, so the ray's height above it is linear between the cell's border, its
// diagonal and its border again. It meets the ground where that height passes zero.
//
//     o---------o---------o
//     |  \      |    \    |
//     |    \  __|__----\--|--       heights are taken at the bars
//     |   __ |  |        \|
//     o--|------o---------o
#include "terrain/surface.glsl"

uniform usampler2D tile_levels;  // of detail, as drawn

struct Cell {
    ivec2 low;   // samples
    ivec2 high;
};

struct Walk {
    vec2 start;  // steps from base_sample where the walk begins, and for one metre
    vec2 along;
    float height;  // of the ray at the start, relative to the base, and for one metre
    float rise;
};

bool is_cell(ivec2 first) {
    return all(greaterThanEqual(first, ivec2(0))) && all(lessThan(first, samples.xy - 1));
}

// The cell that has this sample or lies to the right and below of it; one of a single step beyond the terrain.
Cell cell_of(ivec2 first) {
    if (!is_cell(first)) return Cell(first, first + 1);
    int level = int(texelFetch(tile_levels, first / tile_quads, 0).r);
    ivec2 low = (first >> level) << level;
    return Cell(low, min(low + (1 << level), samples.xy - 1));
}

// How far along the ray a border of the cell is reached, in columns and in rows.
vec2 way_out(Walk walk, Cell cell) {
    vec2 border = vec2(mix(cell.low, cell.high, greaterThan(walk.along, vec2(0.0))) - base_sample.xy);
    return mix((border - walk.start) / walk.along, vec2(1e30), equal(walk.along, vec2(0.0)));
}

Cell next_cell(Walk walk, Cell cell, vec2 out_at) {
    float t = min(out_at.x, out_at.y);
    ivec2 first = clamp(base_sample.xy + ivec2(floor(walk.start + t * walk.along)), cell.low, cell.high - 1);
    ivec2 beyond = mix(cell.low - 1, cell.high, greaterThan(walk.along, vec2(0.0)));
    return cell_of(out_at.x <= out_at.y ? ivec2(beyond.x, first.y) : ivec2(first.x, beyond.y));
}

Triangle triangle_of(Cell cell, bool south) {
    ivec2 corner = south ? ivec2(cell.low.x, cell.high.y) : ivec2(cell.high.x, cell.low.y);
    return Triangle(relative_to_base(cell.low, sample_height(cell.low)), relative_to_base(corner, sample_height(corner)),
                    relative_to_base(cell.high, sample_height(cell.high)));
}

bool is_missing(Triangle t) {
    return min(t.a.z, min(t.b.z, t.c.z)) < 0.5 * missing_height;
}

// The ray's height above the triangle's plane after t metres.
float height_above(Walk walk, Triangle t, Cell cell, float metres) {
    vec2 place = (walk.start + metres * walk.along - vec2(cell.low - base_sample.xy)) * spacing.xy;
    vec2 gradient = gradient_of(t);
    float ground = t.a.z + gradient.x * place.x - gradient.y * place.y;
    return walk.height + metres * walk.rise - ground;
}

const int nothing_met = 0;  // as far as was asked
const int ground_met = 1;
const int not_known = 2;  // it is too far for `most_cells`

const int most_cells = 32;

// Walks along a ray from one distance to another; the triangle that it meets there from above, if any, or also one
// that it meets from below: the walk may begin below ground that other rays see.
int march(vec3 origin, vec3 direction, float from, float until, bool also_below, out Triangle met) {
    vec3 begin = origin + from * direction;
    Walk walk = Walk(vec2(begin.x, -begin.y) / spacing.xy + base_sample_fraction.xy,
                     vec2(direction.x, -direction.y) / spacing.xy, begin.z, direction.z);
    Cell cell = cell_of(base_sample.xy + ivec2(floor(walk.start)));
    float entered = 0.0;
    float height = 0.0;  // above the ground at the end of the last piece
    bool on_ground = false;
    bool found = false;
    int turn = 0;
    do {
        vec2 out_at = way_out(walk, cell);
        float left = min(out_at.x, out_at.y);
        vec2 across = vec2(cell.high - cell.low);
        vec2 place = (walk.start - vec2(cell.low - base_sample.xy)) / across;
        vec2 speed = walk.along / across;
        // Above 0: south of the diagonal.
        float diagonal = (place.y - place.x) + entered * (speed.y - speed.x);
        float middle = entered - diagonal / (speed.y - speed.x);
        bool crosses = middle > entered && middle < left;
        bool south = crosses ? diagonal > 0.0 : place.y - place.x + 0.5 * (entered + left) * (speed.y - speed.x) > 0.0;
        for (int piece = 0; piece < 2; ++piece) {
            float first = piece == 0 ? entered : middle;
            float last = piece == 0 && crosses ? middle : left;
            Triangle t = triangle_of(cell, (piece == 0) == south);
            bool solid = is_cell(cell.low) && !is_missing(t);
            float before = on_ground ? height : height_above(walk, t, cell, first);
            float after = height_above(walk, t, cell, last);
            bool counts = !found && (piece == 0 || crosses);
            bool falls = before > 0.0 && after <= 0.0;
            bool rises = before < 0.0 && after >= 0.0;
            if (counts && solid && (falls || (rises && also_below))) {
                met = t;
                found = true;
            }
            height = counts ? after : height;
            on_ground = counts ? solid : on_ground;
        }
        cell = next_cell(walk, cell, out_at);
        entered = left;
        ++turn;
    } while (!found && turn < most_cells && from + entered < until);
    return found ? ground_met : from + entered < until ? not_known : nothing_met;
}

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

// The ground in a cell: heights of its corners, relative to the base.
struct Corners {
    float north_west;
    float north_east;
    float south_west;
    float south_east;
};

float relative_height(ivec2 sample_index) {
    return (sample_height(sample_index) - base_sample_fraction.z) - base_sample_fraction.w;
}

Corners corners_of(Cell cell) {
    return Corners(relative_height(cell.low), relative_height(ivec2(cell.high.x, cell.low.y)),
                   relative_height(ivec2(cell.low.x, cell.high.y)), relative_height(cell.high));
}

// The height at a place in the cell, from 0 to 1 to the east and to the south, on one of its triangles.
float ground_at(Corners c, vec2 place, bool south) {
    return south ? c.north_west + place.y * (c.south_west - c.north_west) + place.x * (c.south_east - c.south_west)
                 : c.north_west + place.x * (c.north_east - c.north_west) + place.y * (c.south_east - c.north_east);
}

bool is_solid(Corners c, bool south) {
    return min(min(c.north_west, c.south_east), south ? c.south_west : c.north_east) > 0.5 * missing_height;
}

Triangle triangle_of(Cell cell, bool south) {
    ivec2 corner = south ? ivec2(cell.low.x, cell.high.y) : ivec2(cell.high.x, cell.low.y);
    return Triangle(relative_to_base(cell.low, sample_height(cell.low)), relative_to_base(corner, sample_height(corner)),
                    relative_to_base(cell.high, sample_height(cell.high)));
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
    bool met_south = false;
    Cell met_in = cell;
    int turn = 0;
    do {
        vec2 out_at = way_out(walk, cell);
        float left = min(out_at.x, out_at.y);
        vec2 across = vec2(cell.high - cell.low);
        vec2 place = (walk.start - vec2(cell.low - base_sample.xy)) / across;
        vec2 speed = walk.along / across;
        // Above 0: south of the diagonal.
        float offside = place.y - place.x;
        float drift = speed.y - speed.x;
        float middle = -offside / drift;
        bool crosses = middle > entered && middle < left;
        bool south = crosses ? offside + entered * drift > 0.0 : offside + 0.5 * (entered + left) * drift > 0.0;
        Corners ground = corners_of(cell);
        bool inside = is_cell(cell.low);
        for (int piece = 0; piece < 2; ++piece) {
            bool this_south = south == (piece == 0);
            float first = piece == 0 ? entered : middle;
            float last = piece == 0 && crosses ? middle : left;
            bool solid = inside && is_solid(ground, this_south);
            float begin_height = walk.height + first * walk.rise - ground_at(ground, place + first * speed, this_south);
            float before = on_ground ? height : begin_height;
            float after = walk.height + last * walk.rise - ground_at(ground, place + last * speed, this_south);
            bool counts = !found && (piece == 0 || crosses);
            bool falls = before > 0.0 && after <= 0.0;
            bool rises = before < 0.0 && after >= 0.0;
            if (counts && solid && (falls || (rises && also_below))) {
                met_in = cell;
                met_south = this_south;
                found = true;
            }
            height = counts ? after : height;
            on_ground = counts ? solid : on_ground;
        }
        cell = next_cell(walk, cell, out_at);
        entered = left;
        ++turn;
    } while (!found && turn < most_cells && from + entered < until);
    met = triangle_of(met_in, met_south);
    return found ? ground_met : from + entered < until ? not_known : nothing_met;
}

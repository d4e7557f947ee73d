// Matched vertices: places along the segments, and the height of the surface there.
//
//     NW ---- NE     the triangles of terrain/mesh.glsl; beyond the outer samples the ground goes on level. Where
//     |  \  u  |     samples are missing their neighbours stand in, since a line may be seen beside a hole.
//     | l   \  |
//     SW ---- SE
//
// ARCS   some line has a pattern: how far along it each vertex lies
#include "technique/dynamic_lines/items.glsl"
#include "technique/dynamic_lines/subdivision.glsl"

uniform usamplerBuffer piece_offsets;  // prefix sums of the pieces
uniform sampler2D heights;
uniform float stand_in_height;

layout(std430, binding = 0) writeonly buffer Vertices {
    MatchedVertex vertices[];
};

#ifdef ARCS
uniform samplerBuffer arc_lengths;  // of each line: metres that 2^32 in `arc` stand for; 0: no pattern

layout(std430, binding = 1) writeonly buffer Arcs {
    uint arcs[];
};
#endif

const float missing_height = -1e30;

// The last source vertex whose matched vertices begin at or before one.
uint source_of(uint vertex) {
    uint low = 0u, high = uint(textureSize(piece_offsets)) - 1u;
    do {
        uint middle = (low + high) / 2u;
        if (texelFetch(piece_offsets, int(middle)).r <= vertex) low = middle;
        else high = middle;
    } while (high - low > 1u);
    return low;
}

float sample_at(ivec2 place) {
    return texelFetch(heights, clamp(place, ivec2(0), textureSize(heights, 0) - 1), 0).r;
}

// The mean of the samples there are around a cell.
float height_beside(ivec2 cell) {
    float sum = 0.0, count = 0.0;
    for (int i = 0; i < 16; ++i) {
        float height = sample_at(cell + ivec2(i % 4 - 1, i / 4 - 1));
        bool there = height > missing_height;
        sum += there ? height : 0.0;
        count += there ? 1.0 : 0.0;
    }
    return count > 0.0 ? sum / count : stand_in_height;
}

float height_at(ivec2 place) {
    dvec2 at = dvec2(place) * grid.xz + grid.yw;
    at = clamp(at, dvec2(0.0), dvec2(textureSize(heights, 0) - 1));
    ivec2 cell = min(ivec2(floor(at)), textureSize(heights, 0) - 2);
    vec2 inside = vec2(at - dvec2(cell));
    float north_west = sample_at(cell), south_east = sample_at(cell + 1);
    bool south = inside.y > inside.x;
    float third = sample_at(cell + (south ? ivec2(0, 1) : ivec2(1, 0)));
    if (min(min(north_west, south_east), third) < missing_height) return height_beside(cell);
    vec2 slope = south ? vec2(south_east - third, third - north_west) : vec2(third - north_west, south_east - third);
    return north_west + dot(slope, inside);
}

#ifdef ARCS
// A share of the way from one vertex to the next. Whole turns of `arc` are told by the distance.
uint arc_between(SourceVertex from, SourceVertex to, double share) {
    double whole = double(texelFetch(arc_lengths, int(from.line)).r);
    if (whole == 0.0lf) return 0u;
    const double turn = 4294967296.0lf;
    dvec2 way = dvec2(to.place) - dvec2(from.place);
    double turned = double(to.arc - from.arc) / turn;
    double turns = round(sqrt(way.x * way.x + way.y * way.y) * steps.x / whole - turned) + turned;
    double at = share * turns;
    return from.arc + uint((at - floor(at)) * (turn - 1.0lf));
}
#endif

void main() {
    uint vertex = this_item();
    if (vertex >= item_count) return;
    uint source_index = source_of(vertex);
    SourceVertex source = source_at(source_index);
    uint first = texelFetch(piece_offsets, int(source_index)).r;
    ivec2 place = source.place;
#ifdef ARCS
    uint arc = source.arc;
#endif
    if (vertex > first) {
        SourceVertex next = source_at(source_index + 1u);
        double share = double(vertex - first) / double(pieces_of(place, next.place));
        dvec2 way = dvec2(next.place) - dvec2(place);
        place += ivec2(round(way * share));
#ifdef ARCS
        arc = arc_between(source, next, share);
#endif
    }
#ifdef ARCS
    arcs[this_record()] = arc;
#endif
    vertices[this_record()] = MatchedVertex(place, height_at(place), source.line);
}

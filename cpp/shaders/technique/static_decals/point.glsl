// Which features cover a point: one walk over the texels of its cell.
//
// After Zechmeister 2020, algorithm 3.5, with a flat run of groups in draw order in place of a tree: the runs are a
// few texels long, and neighbouring pixels walk them in step. Rings are decided as ring_cells.h describes.
#include "technique/static_decals/cells.glsl"

bool within_stroke(vec4 piece, vec2 point, float half_width2) {
    vec2 along = piece.zw - piece.xy;
    vec2 from = point - piece.xy;
    float t = clamp(dot(from, along) / max(dot(along, along), 1e-6), 0.0, 1.0);
    vec2 apart = from - t * along;
    return dot(apart, apart) <= half_width2;
}

bool crosses_walk(vec4 piece, vec2 point) {
    vec2 along = piece.zw - piece.xy;
    vec2 from = point - piece.xy;
    bool on_row = piece.y <= point.y && point.y < piece.w && from.x * along.y >= from.y * along.x;
    return on_row != (border_crossing(piece) <= point.y);
}

bool meets(Group group, vec4 piece, vec2 local) {
    vec2 point = local * group.scale + float(COORDINATE_BIAS);
    if (group.is_line) return within_stroke(piece, point, group.half_width2);
    return crosses_walk(piece, point);
}

// The state of a walk. Groups end where the next begins, or with the cell.
struct Walk {
    uint at;
    uint end;
    Group group;
    bool covered;  // by the pieces of the group so far
};

Walk begin_walk(ivec2 cell) {
    uvec2 range = cell_range(cell);
    Walk walk;
    walk.at = range.x;
    walk.end = range.y;
    walk.group.slot = 0u;
    walk.group.is_line = false;
    walk.group.scale = 1.0;
    walk.group.half_width2 = 0.0;
    walk.covered = false;
    return walk;
}

// Goes on to the next feature that covers the point and puts its slot into `slot`; false when there is none.
bool next_feature(inout Walk walk, vec2 local, out uint slot) {
    bool found = false;
    while (walk.at < walk.end && !found) {
        uvec2 texel = texelFetch(cell_texels, int(walk.at++)).rg;
        if (is_header(texel)) {
            found = walk.covered;
            slot = walk.group.slot;
            walk.group = read_group(texel);
            walk.covered = covers_corner(texel);
        } else {
            bool hit = meets(walk.group, read_piece(texel), local);
            walk.covered = walk.group.is_line ? walk.covered || hit : walk.covered != hit;
        }
    }
    if (!found && walk.covered) {
        found = true;
        slot = walk.group.slot;
        walk.covered = false;
    }
    return found;
}

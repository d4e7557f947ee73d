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

bool crosses(Group group, vec4 piece, vec2 local) {
    vec2 point = local * group.scale + float(COORDINATE_BIAS);
#if defined(LINES) && defined(RINGS)
    return group.is_line ? within_stroke(piece, point, group.half_width2) : crosses_walk(piece, point);
#elif defined(LINES)
    return within_stroke(piece, point, group.half_width2);
#else
    return crosses_walk(piece, point);
#endif
}

// Starts a group or goes on with it; true when its last piece is done.
bool step_walk(inout uint at, inout Group group, inout bool covered, vec2 local) {
    uvec2 texel = texelFetch(cell_texels, int(at++)).rg;
    if (group.count == 0u) {
        group = read_group(texel);
        covered = group.covers;
    } else {
        bool hit = crosses(group, read_piece(texel), local);
        covered = group.is_line ? covered || hit : covered != hit;
        --group.count;
    }
    return group.count == 0u;
}

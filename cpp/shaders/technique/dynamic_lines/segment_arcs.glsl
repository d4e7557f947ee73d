// How far along its line a segment begins, and how long it is: what line_patterns.glsl reads.
#include "technique/dynamic_lines/line_looks.glsl"
#include "technique/dynamic_lines/line_patterns.glsl"

uniform usamplerBuffer line_arcs;

// `segment` names its vertices, which are so many metres apart: whole turns of `arc` are told by that.
uvec2 arcs_of(uvec4 segment, float across, uint slot) {
    float whole = texelFetch(line_patterns, int(look_of(slot).pattern)).w;
    uint from = texelFetch(line_arcs, int(segment.y)).r, to = texelFetch(line_arcs, int(segment.z)).r;
    float turned = float(to - from) / 4294967296.0;
    float turns = round(across / max(whole, 1e-30) - turned) + turned;
    return uvec2(from, floatBitsToUint(turns));
}

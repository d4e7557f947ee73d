// Terrain vertices: heights from the sample texture, projected and snapped to 1/256 of a pixel.
//
// The rasteriser snaps too, but after adding the viewport's origin in float32. Snapping first makes the same
// triangles cover the same pixels however the picture is cut into rectangles. Of a jittered picture, the ground moves
// against the pixels' centres.
#include "terrain/mesh.glsl"

uniform float stand_in_height;  // for missing samples: their triangles are discarded, but must be drawable

void main() {
    int side = (tile_quads >> tile_level) + 1;
    ivec2 index = mesh_sample(ivec2(gl_VertexID % side, gl_VertexID / side));
    float height = sample_height(index);
    if (height < missing_height) height = stand_in_height;
    vec4 clip = clip_from_base * vec4(relative_to_base(index, height), 1.0);
    clip.xy -= 2.0 * jitter.xy / spacing.zw * clip.w;
    if (clip.w > 0.0) {
        vec2 steps = 128.0 * spacing.zw;
        clip.xy = round(clip.xy / clip.w * steps) / steps * clip.w;
    }
    gl_Position = clip;
}

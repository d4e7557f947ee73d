// Which of the gathered pixels' samples need rays of their own, 1, others 0: where very many facets are seen, or, in a
// pixel that is marked as a silhouette, more than one surface or the sky.
#define WHOLE 1
#include "shared/gathered.glsl"

layout(location = 0) out float many;

uniform sampler2D ray_surface_texture;  // of 4 x 4 rays a pixel
uniform sampler2D marks_texture;        // compose/silhouettes.frag.glsl

const int ray_count = 16;
const int most_facets = 7;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 met[ray_count];
    int facets = 0;
    for (int i = 0; i < ray_count; ++i) {
        vec3 surface = texelFetch(ray_surface_texture, 4 * pixel + ivec2(i & 3, i >> 2), 0).xyz;
        met[i] = vec3(surface.xy, float(isinf(surface.z)));
        bool seen = false;
        for (int k = 0; k < i; ++k) seen = seen || met[k] == met[i];
        facets += int(!seen);
    }
    bool is_silhouette = texelFetch(marks_texture, gathered_pixel(), 0).r == 1.0;
    many = float(facets > (is_silhouette ? 1 : most_facets));
}

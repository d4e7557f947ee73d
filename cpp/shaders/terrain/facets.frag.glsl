// Which of the gathered pixels see so many facets that each of their samples needs a ray of its own: 1, others 0.
layout(location = 0) out float many;

uniform sampler2D ray_surface_texture;  // of 4 x 4 rays a pixel

const int ray_count = 16;
const int most_facets = 7;

void main() {
    ivec2 corner = 4 * ivec2(gl_FragCoord.xy);
    vec2 gradients[ray_count];
    int facets = 0;
    for (int i = 0; i < ray_count; ++i) {
        gradients[i] = texelFetch(ray_surface_texture, corner + ivec2(i & 3, i >> 2), 0).xy;
        bool seen = false;
        for (int k = 0; k < i; ++k) seen = seen || gradients[k] == gradients[i];
        facets += int(!seen);
    }
    many = float(facets > most_facets);
}

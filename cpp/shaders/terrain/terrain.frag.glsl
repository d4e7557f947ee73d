// The G-buffer: where each pixel's ray meets the plane of the triangle that covers it.
//
// The position is solved and not interpolated, since interpolated attributes carry the rasteriser's 1/256 of a pixel,
// which near the horizon is metres. A triangle seen edge-on may cover a pixel whose ray meets its plane far away:
// the distance is kept within that of its corners, and to where the ray is above or below the triangle.
//
// HOLES          the terrain has missing samples
// RAMP           colours by height
// MULTISAMPLED   each of the driver's samples by itself
#include "terrain/surface.glsl"

// The corners of the triangle in hand, in the order of the tile's index buffer (terrain_mesh.cpp).
Triangle covering_triangle() {
    int quads = tile_quads >> tile_level;
    int quad = gl_PrimitiveID >> 1;
    ivec2 north_west = ivec2(quad % quads, quad / quads);
    ivec2 a = mesh_sample(north_west);
    ivec2 b = mesh_sample(north_west + ((gl_PrimitiveID & 1) == 0 ? ivec2(0, 1) : ivec2(1, 1)));
    ivec2 c = mesh_sample(north_west + ((gl_PrimitiveID & 1) == 0 ? ivec2(1, 1) : ivec2(1, 0)));
    vec3 h = vec3(sample_height(a), sample_height(b), sample_height(c));
#ifdef HOLES
    if (any(lessThan(h, vec3(missing_height)))) discard;
#endif
    return Triangle(relative_to_base(a, h.x), relative_to_base(b, h.y), relative_to_base(c, h.z));
}

void main() {
    Triangle triangle = covering_triangle();
    vec2 pixel = pixel_from_centre();
    vec2 gradient = gradient_of(triangle);
    float distance = distance_along_ray(triangle, gradient, ray_origin_at(pixel), ray_direction_at(pixel));
    write_surface(pixel, gradient, distance);
}

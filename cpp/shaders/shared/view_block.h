// The view: what every pass knows of the camera and the picture. One struct for C++ and GLSL (std140).
//
// All positions are relative to the base: the point on the camera's axis at the depth where the visible
// terrain begins, or the eye itself. The base is held as integer parts and small fractions. So float32 is
// enough at any distance from the coordinates' origin, and of the eye from the terrain. A pixel's ray is
//
//     origin     x * ray_origin_dx + y * ray_origin_dy         on the plane through the base
//     direction  ray_direction + x * ray_direction_dx + y * ray_direction_dy
//
// with x, y in pixels from the picture's centre, y upwards. The direction advances one metre along the
// camera's axis for each unit, so the planar eye depth is the base's depth and the distance along the ray.
//
//     eye ----------- base ~~~~~~~~ terrain
//         forward.w        distance
#ifndef DECALGL_VIEW_BLOCK_H
#define DECALGL_VIEW_BLOCK_H

#ifdef __cplusplus
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
namespace decalgl {
using glm::ivec4;
using glm::mat4;
using glm::vec4;
struct ViewBlock {
#else
layout(std140, binding = 0) uniform ViewBlock {
#endif
    mat4 clip_from_base;
    vec4 forward;  // unit vector; w: depth of the base
    vec4 ray_direction;
    vec4 ray_direction_dx;
    vec4 ray_direction_dy;
    vec4 ray_origin_dx;
    vec4 ray_origin_dy;
    vec4 base_offset;  // x, y: metres inside the base's block; z: size of a block; w: smallest distance seen
    vec4 base_sample_fraction;  // x, y: the base's place past its sample; z, w: its height, high and low part
    vec4 spacing;               // x, y: metres between terrain samples; z, w: picture size in pixels
    ivec4 base_block;           // x, y
    ivec4 base_sample;          // x: column, y: row
    ivec4 samples;              // x: columns, y: rows of the terrain
    ivec4 picture;              // x, y: first pixel of this rectangle; z, w: size of the whole picture
    vec4 jitter;                // x, y: where in its pixel the sample in hand lies, in pixels from the centre
#ifdef __cplusplus
};
static_assert(sizeof(ViewBlock) == 64 + 14 * 16, "std140 layout");
}  // namespace decalgl
#else
};
#endif

#endif

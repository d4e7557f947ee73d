// The size of the table of half planes (half_planes.glsl). Read by C++ and GLSL alike.
#ifndef DECALGL_HALF_PLANE_TABLE_H
#define DECALGL_HALF_PLANE_TABLE_H

#define HALF_PLANE_TURNS 256    // directions in half a turn
#define HALF_PLANE_OFFSETS 256  // distances from one corner of the pixel to the opposite one

#endif

// Which of a pixel's samples lie in a half plane, from a table (half_planes.cpp).
//
// After Carpenter 1984, "The A-buffer, an antialiased hidden surface method". A half plane that covers a share of the
// pixel has that share of the samples, rounded: those that lie deepest in it. So an edge errs by 1/128 of the pixel
// and by the table's own steps, and not by where the samples happen to lie. Of two parallel half planes one has all
// samples of the other, and opposite ones share the samples out between them.
//
//     row      direction (a, b) of the half plane a x + b y + distance >= 0, as the turn from the x axis by the
//              place on the diamond |a| + |b| = 1; the lower half turn is the opposite of the upper one
//     column   distance / (|a| + |b|), from -1/2, where no sample is in, to 1/2, where all are
#include "shared/half_plane_table.h"
#include "shared/sample_masks.glsl"

uniform usamplerBuffer half_planes;

struct Direction {
    int row;
    float columns;  // for a distance of 1
    uvec2 flip;     // of the samples
};

// Which way the distance grows: by these numbers for a pixel to the right and for one up.
Direction direction_of(vec2 growth) {
    float share = 1.0 / max(abs(growth.x) + abs(growth.y), 1e-30);
    bool lower = growth.y < 0.0;
    float rise = abs(growth.y) * share;
    float turn = (growth.x < 0.0) == lower ? rise : 2.0 - rise;
    Direction direction;
    direction.row = int(turn * float(HALF_PLANE_TURNS / 2) + 0.5) * HALF_PLANE_OFFSETS;
    direction.columns = (lower ? -share : share) * float(HALF_PLANE_OFFSETS - 1);
    direction.flip = lower ? all_samples : no_samples;
    return direction;
}

// Samples whose distance is 0 or more, where that of the pixel's centre is `distance`.
uvec2 samples_beyond(Direction direction, float distance) {
    float column = distance * direction.columns + 0.5 * float(HALF_PLANE_OFFSETS);
    int at = direction.row + int(clamp(column, 0.0, float(HALF_PLANE_OFFSETS) - 0.5));
    return texelFetch(half_planes, at).rg ^ direction.flip;
}

// Whether some border passes through a pixel, and in which direction the nearest to its centre does.
//
// Pixels without one are of one colour. The others are seen at places that follow the border's direction (sample_place.glsl).
// A border that is hidden, or none after all, costs no more than time.
#include "technique/static_bvh/search.glsl"

// ratio: of the distance of the nearest border to how far the pixel reaches towards it, more than 1 where there is none.
// growth: of the distance for a pixel to the right and one up; of no length where the direction is not known.
struct Borders {
    float ratio;
    vec2 growth;
};

const float no_border = 2.0;
const float known = 0.9;     // ratios of borders of which the direction is known stay below
const float rounded = 1.01;  // so much farther may a border be than it seems

float half_extent(vec2 across) {
    return 0.5 * (abs(across.x) + abs(across.y));
}

// Of the pixel's farthest corner from its centre.
float pixel_radius(mat2 foot) {
    return 0.5 * max(length(foot[0] + foot[1]), length(foot[0] - foot[1]));
}

void add_unknown(inout Borders borders) {
    borders.ratio = min(borders.ratio, 1.0);
}

// A straight border at a distance along a normal of unit length.
bool add_line(inout Borders borders, vec2 normal, float distance, mat2 foot) {
    vec2 growth = normal * foot;
    float ratio = abs(distance) / max(half_extent(growth), 1e-30);
    if (ratio > rounded) return false;
    if (known * ratio / rounded < borders.ratio) borders = Borders(known * ratio / rounded, growth);
    return true;
}

// A round one around a point, from which `from` leads to the pixel's centre.
void add_circle(inout Borders borders, vec2 from, float radius, mat2 foot) {
    float away = length(from);
    float ratio = abs(away - radius) / max(pixel_radius(foot), 1e-30);
    if (ratio <= rounded && known * ratio / rounded < borders.ratio)
        borders = Borders(known * ratio / rounded, from / max(away, 1e-30) * foot);
}

// What a picture is asked to be. Equal requests of one prepared scene over one background give equal bytes.
#pragma once

#include <array>

#include "decalgl/frame/camera.h"
#include "decalgl/technique/technique.h"

namespace decalgl {

struct Rectangle {
    int x = 0;  // of the lower left pixel, counted from the picture's lower left
    int y = 0;
    int width = 0;
    int height = 0;
};

// What stands where there is no terrain: straight alpha, 0..1, sRGB.
struct Background {
    std::array<float, 4> low{0.87F, 0.91F, 0.94F, 1.0F};   // at the horizon
    std::array<float, 4> high{0.53F, 0.70F, 0.86F, 1.0F};  // 45 degrees above it

    bool operator==(const Background& other) const { return low == other.low && high == other.high; }
};

struct PictureRequest {
    Camera camera;
    int width = 0;
    int height = 0;
    Antialias antialias = Antialias::coverage;
    double terrain_error = 0.5;  // pixels; 0: every sample
};

}  // namespace decalgl

// A frame: one picture, and everything that can be asked about its pixels.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "decalgl/core/timing.h"

namespace decalgl {

struct FrameState;

struct FrameStats {
    std::vector<TimedPass> passes;      // of the last picture, in order
    std::vector<TimedPass> preprocess;  // its parts
    double preprocess_ms = 0.0;
    double update_ms = 0.0;
    double render_ms = 0.0;
    double readback_ms = 0.0;
    std::vector<std::pair<std::string, uint64_t>> bytes;  // by owner, GL and CPU
    std::vector<std::pair<std::string, double>>
        counts;                         // triangles, features, segments, pieces, quantum_m, ...
    std::vector<std::string> variants;  // program variants compiled so far
};

struct PickedFeature {
    int32_t layer = 0;  // place in the scene
    int64_t row = 0;    // in the user's data
};

// Pixel (x, y) counts from the picture's upper left; arrays are row by row from the top. All but the image
// are made when first asked for, on the thread that owns the renderer; they stay right after the renderer has
// gone on to other views or scenes.
class Frame {
public:
    explicit Frame(std::shared_ptr<FrameState> state) : state_(std::move(state)) {}

    int width() const;
    int height() const;
    const std::vector<uint8_t>& image() const;   // R, G, B, A a pixel, sRGB, straight alpha
    const std::vector<int64_t>& ids() const;     // row of the topmost feature at the pixel's centre, -1: none
    const std::vector<int32_t>& layers() const;  // its layer, -1: none
    const std::vector<float>& depth() const;     // planar eye depth in metres, infinite where there is sky
    const std::vector<double>& world() const;    // x, y, z a pixel, NaN where there is sky
    // Every feature at a pixel's centre, topmost first. Throws Error(input) outside the picture.
    std::vector<PickedFeature> pick(int x, int y) const;
    const FrameStats& stats() const;

private:
    std::shared_ptr<FrameState> state_;
};

}  // namespace decalgl

// How the bare terrain looks: its colour and its hillshade.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "decalgl/terrain/heightfield.h"

namespace decalgl {

struct Relief {
    std::array<uint8_t, 3> color{0xE9, 0xE5, 0xDC};
    // Colours from `lowest` to `highest` metres, R, G, B bytes each, evenly spaced; empty: `color`
    // everywhere.
    std::vector<uint8_t> ramp;
    double lowest = 0.0;
    double highest = 1.0;
    double azimuth = 315.0;  // degrees clockwise from north that the light comes from
    double altitude = 45.0;  // degrees above the horizon
    double strength = 0.6;   // 0: no hillshade. Level ground keeps its colour at any strength
    double on_layers = 0.0;  // the share of the hillshade that layers take on too
};

// Lambert's cosine for each sample, 0 to 255, from central differences.
std::vector<uint8_t> illuminate(const Heightfield& heightfield, const Relief& relief, unsigned threads);

}  // namespace decalgl

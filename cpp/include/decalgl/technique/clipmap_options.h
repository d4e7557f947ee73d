// What users may choose of clipmap textures (Taibo et al. 2014).
#pragma once

#include <tuple>

#include "decalgl/vector/layer.h"

namespace decalgl::clipmap {

// How lines get into tiles: section 4 of the paper.
enum class LineSolution : uint8_t {
    primitives,    // 1: line primitives
    polygons,      // 2: tessellated before
    both,          // 3a: 2, and 1 where they are thin
    wireframe,     // 3b: 2, and its edges where they are thin
    geometry,      // 4a: tessellated by a geometry shader from a line with adjacency
    offsets,       // 4b: by offsets that were worked out before
    polar_offsets  // 4b with offsets in polar coordinates
};

enum class JointMethod : uint8_t {
    none,         // 1: segments end across, and do not meet
    own_corners,  // 3a: bevels with both segments' own corners
    inner_meets   // 3b: where the inner borders meet; else their own corners
};

struct ClipmapOptions : TechniqueOptions {
    LineSolution solution = LineSolution::offsets;
    JointMethod joints = JointMethod::inner_meets;
    double bevel_below = 90.0;  // degrees between the segments of a joint; wider ones by method 2
    double thin_below = 1.5;    // texels: thinner lines are line primitives (algorithm 2)
    double widest_line = 10.0;  // texels of a line primitive, to which wider ones are clamped
    double widen_from = 0.0;    // metres from the camera to the ground: from here on widths grow as it does,
    double widen_to = 0.0;      // up to here; 0: they stay
    int window = 0;             // texels of a level that are kept; 0: as many as the picture is wide
    int samples = 4;            // of a texel: 1, 2 or 4
    int anisotropy = 8;         // most samples along a pixel's longer side
    int tiles_a_frame = 0;      // drawn anew for a picture; 0: as many as it needs

    auto members() const {
        return std::make_tuple(solution, joints, bevel_below, thin_below, widest_line, widen_from, widen_to,
                               window, samples, anisotropy, tiles_a_frame);
    }
    bool equals(const TechniqueOptions& other) const override {
        const auto* options = dynamic_cast<const ClipmapOptions*>(&other);
        return options != nullptr && options->members() == members();
    }
    void write(ChoiceBytes& choices) const override { choices.add(members()); }
};

}  // namespace decalgl::clipmap

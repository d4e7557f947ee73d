// Where in a pixel the samples of a picture lie.
#pragma once

#include <glm/vec2.hpp>
#include <vector>

namespace decalgl {

constexpr int most_samples = 32;

// Whether there is a pattern of this many: a power of two, up to most_samples.
bool has_sample_pattern(int count);

// In pixels from the centre. Each of `count` columns and rows of the pixel holds one sample in its middle, so
// their mean is the centre, and so does every other partition into `count` equal boxes of powers of two.
std::vector<glm::vec2> sample_pattern(int count);

}  // namespace decalgl

#include "technique/half_planes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numeric>

#include "shared/area_samples.h"
#include "shared/half_plane_table.h"

namespace decalgl {
namespace {

const std::array<glm::dvec2, AREA_SAMPLE_COUNT> sample_offsets{AREA_SAMPLE_OFFSETS(glm::dvec2)};

// The direction on the diamond |a| + |b| = 1 of a row, from the x axis over the y axis.
glm::dvec2 direction_of(int row) {
    const double turn = row / (HALF_PLANE_TURNS / 2.0);
    return {1.0 - turn, turn <= 1.0 ? turn : 2.0 - turn};
}

// The share of the unit square around the origin where a x + b y + distance >= 0, for |a| + |b| = 1.
double covered_share(glm::dvec2 direction, double distance) {
    const double wide = std::max(std::abs(direction.x), std::abs(direction.y)), narrow = 1.0 - wide;
    const double from_corner = 0.5 - std::abs(distance);
    const double beyond = from_corner < narrow ? from_corner * from_corner / (2.0 * wide * narrow)
                                               : (from_corner - 0.5 * narrow) / wide;
    return distance < 0.0 ? beyond : 1.0 - beyond;
}

}  // namespace

std::vector<uint64_t> make_half_planes() {
    std::vector<uint64_t> table;
    table.reserve(size_t{HALF_PLANE_TURNS + 1} * HALF_PLANE_OFFSETS);
    for (int row = 0; row <= HALF_PLANE_TURNS; ++row) {
        const glm::dvec2 direction = direction_of(row);
        std::array<size_t, AREA_SAMPLE_COUNT> deepest_first{};
        std::iota(deepest_first.begin(), deepest_first.end(), size_t{0});
        std::stable_sort(deepest_first.begin(), deepest_first.end(), [&](size_t a, size_t b) {
            return glm::dot(direction, sample_offsets[a]) > glm::dot(direction, sample_offsets[b]);
        });
        for (int column = 0; column < HALF_PLANE_OFFSETS; ++column) {
            const double distance = column / (HALF_PLANE_OFFSETS - 1.0) - 0.5;
            const auto count =
                static_cast<size_t>(std::lrint(AREA_SAMPLE_COUNT * covered_share(direction, distance)));
            uint64_t samples = 0;
            for (size_t i = 0; i < count; ++i)
                samples |= uint64_t{1} << deepest_first[i];
            table.push_back(samples);
        }
    }
    return table;
}

}  // namespace decalgl

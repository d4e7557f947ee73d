#include "technique/dynamic_lines/line_blocks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "technique/view_base.h"

namespace decalgl {
namespace {

constexpr uint32_t block_vertices = 32;
// Pixels by which boxes reach farther than segments: samples lie off the pixels' centres, and shaders compute in float32.
constexpr double spare_px = 2.0;

// The farthest that a range goes along one axis of a plane's normal.
double farthest(double normal, double low, double high) {
    return std::max(normal * low, normal * high);
}

}  // namespace

// A block is of one line, and ends with the vertex that the next one begins with.
LineBlocks::LineBlocks(const PreparedLines& prepared) {
    const LineLattice& lattice = prepared.lattice;
    for (const LineRecord& line : prepared.lines.span()) {
        for (uint32_t first = 0; first + 1 < line.count; first += block_vertices) {
            ivec2 low = prepared.vertices[line.first + first].place, high = low;
            for (uint32_t i = first; i <= std::min(first + block_vertices, line.count - 1); ++i) {
                low = glm::min(low, prepared.vertices[line.first + i].place);
                high = glm::max(high, prepared.vertices[line.first + i].place);
            }
            boxes_.push_back({lattice.x_of(low), lattice.y_of(low), lattice.x_of(high), lattice.y_of(high)});
        }
    }
}

bool LineBlocks::may_show(const View& view, glm::vec2 ground_heights, LineReach reach) const {
    const glm::dmat4 clip = glm::transpose(glm::dmat4(view.block->clip_from_base));
    const glm::dvec4 x = clip[0], y = clip[1], w = clip[3];
    const double across = 1.0 + 2.0 * (static_cast<double>(reach.px) + spare_px) / view.width;
    const double upwards = 1.0 + 2.0 * (static_cast<double>(reach.px) + spare_px) / view.height;
    const std::array<glm::dvec4, 5> planes{across * w + x, across * w - x, upwards * w + y, upwards * w - y,
                                           w};
    const std::array<double, 3> base = base_of(view);
    const double lowest = static_cast<double>(ground_heights.x) - base[2];
    const double highest = static_cast<double>(ground_heights.y) - base[2];
    return std::any_of(boxes_.begin(), boxes_.end(), [&](const Bounds& box) {
        return std::all_of(planes.begin(), planes.end(), [&](const glm::dvec4& plane) {
            return farthest(plane.x, box.min_x - base[0], box.max_x - base[0]) +
                       farthest(plane.y, box.min_y - base[1], box.max_y - base[1]) +
                       farthest(plane.z, lowest, highest) + plane.w +
                       static_cast<double>(reach.metres) * glm::length(glm::dvec3(plane)) >=
                   0.0;
        });
    });
}

}  // namespace decalgl

#include "decalgl/terrain/relief.h"

#include <algorithm>
#include <cmath>

#include "decalgl/core/parallel.h"

namespace decalgl {
namespace {

constexpr double radians = 3.14159265358979323846 / 180.0;

// The slope between two samples `steps` apart, 0 where one is missing.
double slope(float from, float to, double distance) {
    const double rise = static_cast<double>(to) - static_cast<double>(from);
    return distance > 0.0 && std::isfinite(rise) ? rise / distance : 0.0;
}

}  // namespace

std::vector<uint8_t> illuminate(const Heightfield& field, const Relief& relief, unsigned threads) {
    const double light_x = std::sin(relief.azimuth * radians) * std::cos(relief.altitude * radians);
    const double light_y = std::cos(relief.azimuth * radians) * std::cos(relief.altitude * radians);
    const double light_z = std::sin(relief.altitude * radians);
    const int32_t columns = field.columns();
    std::vector<uint8_t> cosines(field.heights().size());
    parallel_for(static_cast<size_t>(field.rows()), 64, threads, [&](size_t begin, size_t end) {
        for (auto row = static_cast<int32_t>(begin); row < static_cast<int32_t>(end); ++row) {
            const int32_t north = std::max(row - 1, 0), south = std::min(row + 1, field.rows() - 1);
            for (int32_t column = 0; column < columns; ++column) {
                const int32_t west = std::max(column - 1, 0), east = std::min(column + 1, columns - 1);
                const double gx =
                    slope(field.height(row, west), field.height(row, east), (east - west) * field.dx());
                const double gy = slope(field.height(south, column), field.height(north, column),
                                        (south - north) * field.dy());
                const double cosine =
                    (light_z - gx * light_x - gy * light_y) / std::sqrt(gx * gx + gy * gy + 1.0);
                cosines[static_cast<size_t>(row) * static_cast<size_t>(columns) +
                        static_cast<size_t>(column)] =
                    static_cast<uint8_t>(std::lrint(255.0 * std::clamp(cosine, 0.0, 1.0)));
            }
        }
    });
    return cosines;
}

}  // namespace decalgl

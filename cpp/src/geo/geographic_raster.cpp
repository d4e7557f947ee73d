#include "decalgl/geo/geographic_raster.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "decalgl/core/error.h"
#include "decalgl/core/parallel.h"

namespace decalgl {
namespace {

constexpr int edge_points = 65;
/// Transverse Mercator stretches by a quarter this far from its meridian.
constexpr double farthest = 0.7 * 6378137.0;
/// Shares of a sample: positions this near to a sample, or beyond the border, count as on it, so that
/// rounding neither trims the outer samples nor spreads holes.
constexpr double slack = 1e-3;
constexpr std::size_t samples_a_block = 1 << 15;
constexpr float hole = std::numeric_limits<float>::quiet_NaN();

struct Grid {
    double x0 = 0.0;
    double y0 = 0.0;
    double dx = 0.0;
    double dy = 0.0;
    std::uint64_t rows = 0;
    std::uint64_t columns = 0;
};

[[noreturn]] void refuse_extent() {
    throw Error(ErrorKind::crs,
                "The raster spans too much of the globe for one metric plane. Cut it to the area of interest "
                "first.");
}

void check(const GeographicRaster& raster) {
    const auto count = static_cast<std::uint64_t>(std::max(raster.rows, 0)) *
                       static_cast<std::uint64_t>(std::max(raster.columns, 0));
    if (raster.rows < 2 || raster.columns < 2 || raster.heights.size() != count) {
        throw Error(ErrorKind::input,
                    fmt::format("A raster of {} x {} samples with {} heights cannot be warped. Give "
                                "at least 2 x 2 samples and one height for each.",
                                raster.rows, raster.columns, raster.heights.size()));
    }
    const bool placed = std::isfinite(raster.longitude + raster.latitude) &&
                        std::isfinite(raster.longitude_step * raster.latitude_step) &&
                        raster.longitude_step != 0.0 && raster.latitude_step != 0.0;
    if (!placed) {
        throw Error(
            ErrorKind::input,
            fmt::format("The raster's sample (0, 0) at ({}, {}) and steps ({}, {}) do not "
                        "span a grid. They must be finite, and the steps not 0.",
                        raster.longitude, raster.latitude, raster.longitude_step, raster.latitude_step));
    }
}

glm::dvec2 middle_of(const GeographicRaster& raster) {
    return {0.5 * (raster.columns - 1), 0.5 * (raster.rows - 1)};
}

glm::dvec2 degrees_at(const GeographicRaster& raster, glm::dvec2 sample) {
    return {raster.longitude + sample.x * raster.longitude_step,
            raster.latitude + sample.y * raster.latitude_step};
}

/// Lengths of one column and one row step at the raster's centre, metres on the plane.
glm::dvec2 steps_at_centre(const GeographicRaster& raster, const LocalPlane& plane) {
    const auto length = [&](glm::dvec2 half) {
        const glm::dvec2 start = plane.forward(degrees_at(raster, middle_of(raster) - half));
        const glm::dvec2 end = plane.forward(degrees_at(raster, middle_of(raster) + half));
        return std::hypot(end.x - start.x, end.y - start.y);
    };
    const glm::dvec2 steps(length({0.5, 0.0}), length({0.0, 0.5}));
    if (!(steps.x > 0.0 && steps.y > 0.0 && std::isfinite(steps.x + steps.y))) {
        refuse_extent();
    }
    return steps;
}

/// The rectangle around the raster's samples on the plane.
Bounds extent_on(const LocalPlane& plane, const GeographicRaster& raster) {
    constexpr double far = std::numeric_limits<double>::infinity();
    Bounds bounds{far, far, -far, -far};
    for (int i = 0; i < edge_points; ++i) {
        for (int j = 0; j < edge_points; ++j) {
            const glm::dvec2 share(static_cast<double>(j) / (edge_points - 1),
                                   static_cast<double>(i) / (edge_points - 1));
            const glm::dvec2 point = plane.forward(degrees_at(raster, 2.0 * share * middle_of(raster)));
            if (!std::isfinite(point.x + point.y) || std::abs(point.x) > farthest) {
                refuse_extent();
            }
            bounds = {std::min(bounds.min_x, point.x), std::min(bounds.min_y, point.y),
                      std::max(bounds.max_x, point.x), std::max(bounds.max_y, point.y)};
        }
    }
    return bounds;
}

Grid grid_on(const LocalPlane& plane, const GeographicRaster& raster, std::uint64_t max_samples) {
    const Bounds bounds = extent_on(plane, raster);
    const glm::dvec2 steps = steps_at_centre(raster, plane);
    const double width = bounds.max_x - bounds.min_x;
    const double height = bounds.max_y - bounds.min_y;
    const double columns = std::max(1.0, std::nearbyint(width / steps.x));
    const double rows = std::max(1.0, std::nearbyint(height / steps.y));
    constexpr double most = std::numeric_limits<std::int32_t>::max() - 1;
    if ((columns + 1.0) * (rows + 1.0) > static_cast<double>(max_samples) || columns > most || rows > most) {
        throw Error(ErrorKind::memory,
                    fmt::format("On a metric plane the raster would take {:.0f} x {:.0f} samples, "
                                "more than max_samples={}. Cut it to the area of interest, or raise "
                                "max_samples.",
                                rows + 1.0, columns + 1.0, max_samples));
    }
    return {bounds.min_x,
            bounds.max_y,
            width / columns,
            height / rows,
            static_cast<std::uint64_t>(rows) + 1,
            static_cast<std::uint64_t>(columns) + 1};
}

/// Between two neighbouring samples, 0 to 1, and exactly on one where it is near.
double fraction(double value) {
    const double near = std::nearbyint(value);
    return std::clamp(std::abs(value - near) < slack ? near : value, 0.0, 1.0);
}

float bilinear(const GeographicRaster& raster, glm::dvec2 sample) {
    const bool inside = sample.x >= -slack && sample.x <= raster.columns - 1 + slack && sample.y >= -slack &&
                        sample.y <= raster.rows - 1 + slack;
    if (!inside) {
        return hole;
    }
    const double west = std::clamp(std::floor(sample.x), 0.0, static_cast<double>(raster.columns - 2));
    const double north = std::clamp(std::floor(sample.y), 0.0, static_cast<double>(raster.rows - 2));
    const double u = fraction(sample.x - west);
    const double v = fraction(sample.y - north);
    const float* corner = raster.heights.data() +
                          static_cast<std::size_t>(north) * static_cast<std::size_t>(raster.columns) +
                          static_cast<std::size_t>(west);
    double total = 0.0;
    const auto add = [&](const float* height, double weight) {
        // A missing sample without weight must not turn the sum into a hole.
        if (weight > 0.0) {
            total += static_cast<double>(*height) * weight;
        }
    };
    add(corner, (1.0 - v) * (1.0 - u));
    add(corner + 1, (1.0 - v) * u);
    add(corner + raster.columns, v * (1.0 - u));
    add(corner + raster.columns + 1, v * u);
    return static_cast<float>(total);
}

/// Fractional (column, row) of the raster at a position on the plane.
glm::dvec2 sample_at(const GeographicRaster& raster, const LocalPlane& plane, glm::dvec2 metres) {
    glm::dvec2 degrees = plane.inverse(metres);
    // The raster may lie across the antimeridian, or a whole turn away from the plane's centre.
    const double middle = degrees_at(raster, middle_of(raster)).x;
    degrees.x = middle + std::remainder(degrees.x - middle, 360.0);
    return {(degrees.x - raster.longitude) / raster.longitude_step,
            (degrees.y - raster.latitude) / raster.latitude_step};
}

}  // namespace

LocalPlane plane_around(const GeographicRaster& raster) {
    const glm::dvec2 centre = degrees_at(raster, middle_of(raster));
    return LocalPlane::around(centre.x, centre.y);
}

Heightfield warp_to_plane(const GeographicRaster& raster, const LocalPlane& plane, const WarpLimits& limits) {
    check(raster);
    const Grid grid = grid_on(plane, raster, limits.max_samples);
    std::vector<float> heights(grid.rows * grid.columns);
    const std::size_t rows_a_block = std::max<std::size_t>(1, samples_a_block / grid.columns);
    parallel_for(grid.rows, rows_a_block, limits.threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) {
            const double y = grid.y0 - static_cast<double>(row) * grid.dy;
            for (std::size_t column = 0; column < grid.columns; ++column) {
                const double x = grid.x0 + static_cast<double>(column) * grid.dx;
                heights[row * grid.columns + column] = bilinear(raster, sample_at(raster, plane, {x, y}));
            }
        }
    });
    return Heightfield(std::move(heights), static_cast<std::int32_t>(grid.rows),
                       static_cast<std::int32_t>(grid.columns), grid.x0, grid.y0, grid.dx, grid.dy);
}

}  // namespace decalgl

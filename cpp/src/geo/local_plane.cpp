#include "decalgl/geo/local_plane.h"

#include <fmt/format.h>

#include <GeographicLib/TransverseMercator.hpp>
#include <cmath>
#include <limits>

#include "decalgl/core/error.h"
#include "decalgl/core/parallel.h"

namespace decalgl {
namespace {

constexpr double wgs84_radius = 6378137.0;
constexpr double wgs84_flattening = 1.0 / 298.257223563;
constexpr std::size_t points_a_block = 4096;

double rounded(double degrees) {
    return std::nearbyint(degrees * 1e4) / 1e4;
}

/// Within half a turn of `middle`.
double turned_near(double degrees, double middle) {
    return middle + std::remainder(degrees - middle, 360.0);
}

template <typename Move>
void move_all(Span<const double> from, Span<double> to, unsigned threads, const Move& move) {
    if (from.size() != to.size() || from.size() % 2 != 0) {
        throw Error(ErrorKind::input,
                    fmt::format("Points are moved from an array of {} numbers to one of {}. Give two arrays "
                                "of the same size, two numbers for each point.",
                                from.size(), to.size()));
    }
    parallel_for(from.size() / 2, points_a_block, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t point = begin; point < end; ++point) {
            const glm::dvec2 moved = move({from[2 * point], from[2 * point + 1]});
            to[2 * point] = moved.x;
            to[2 * point + 1] = moved.y;
        }
    });
}

}  // namespace

struct LocalPlane::Projection {
    GeographicLib::TransverseMercator mercator{wgs84_radius, wgs84_flattening, 1.0};
    double centre_northing = 0.0;  // from the equator
};

LocalPlane::LocalPlane(double longitude, double latitude) : longitude_(longitude), latitude_(latitude) {
    if (!std::isfinite(longitude) || !(std::abs(latitude) <= 90.0)) {
        throw Error(ErrorKind::crs, fmt::format("Longitude {} and latitude {} are no place on the globe, so "
                                                "there is no plane around it. Give degrees, longitude first.",
                                                longitude, latitude));
    }
    Projection projection;
    double x = 0.0;
    projection.mercator.Forward(longitude, latitude, longitude, x, projection.centre_northing);
    projection_ = std::make_shared<const Projection>(projection);
}

LocalPlane LocalPlane::around(double longitude, double latitude) {
    return {rounded(turned_near(longitude, 0.0)), rounded(latitude)};
}

glm::dvec2 LocalPlane::forward(glm::dvec2 degrees) const {
    if (!std::isfinite(degrees.x) || !(std::abs(degrees.y) <= 90.0)) {
        return glm::dvec2(std::numeric_limits<double>::quiet_NaN());
    }
    glm::dvec2 metres;
    projection_->mercator.Forward(longitude_, degrees.y, degrees.x, metres.x, metres.y);
    metres.y -= projection_->centre_northing;
    return metres;
}

glm::dvec2 LocalPlane::inverse(glm::dvec2 metres) const {
    if (!std::isfinite(metres.x) || !std::isfinite(metres.y)) {
        return glm::dvec2(std::numeric_limits<double>::quiet_NaN());
    }
    glm::dvec2 degrees;
    projection_->mercator.Reverse(longitude_, metres.x, metres.y + projection_->centre_northing, degrees.y,
                                  degrees.x);
    degrees.x = turned_near(degrees.x, longitude_);
    return degrees;
}

void LocalPlane::forward(Span<const double> from, Span<double> to, unsigned threads) const {
    move_all(from, to, threads, [this](glm::dvec2 point) { return forward(point); });
}

void LocalPlane::inverse(Span<const double> from, Span<double> to, unsigned threads) const {
    move_all(from, to, threads, [this](glm::dvec2 point) { return inverse(point); });
}

}  // namespace decalgl

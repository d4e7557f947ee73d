// What stands for a thin stroke in levels of detail has its area, however it lies.
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "technique/static_decals/thin_stroke.h"

using namespace decalgl;

namespace {

constexpr size_t side = 64;
constexpr double square = 2.0, corner = 10.0;

// How many of 64 x 64 points stand for a stroke through these places, and in how many rows.
struct Count {
    size_t points = 0;
    size_t rows = 0;
};

Count count(const std::vector<Vector2>& places, double radius) {
    ThinStroke<double> stroke;
    stroke.begin(side, square, corner);
    for (size_t i = 0; i < places.size(); ++i)
        stroke.add_edge(places[i == 0 ? 0 : i - 1], places[i], radius, 0, side * side);
    std::vector<double> shares(side * side, 2.0);
    stroke.spread(0, side * side, shares);
    Count found;
    for (size_t row = 0; row < side; ++row) {
        const size_t before = found.points;
        for (size_t i = 0; i < side; ++i)
            found.points += shares[row * side + i] <= 1.0 ? 1 : 0;
        found.rows += found.points > before ? 1 : 0;
    }
    return found;
}

}  // namespace

TEST_CASE("points stand for as much as a thin stroke covers", "[static]") {
    const double radius = GENERATE(0.05, 0.3, 0.9), turn = GENERATE(0.0, 0.2, 0.7854, 1.3, 1.5708, 2.5);
    const double length = 100.0;
    const Vector2 middle{74.0, 74.0}, along{std::cos(turn), std::sin(turn)};
    std::vector<Vector2> places;
    for (int i = 0; i <= 7; ++i) {
        const double at = length * (i / 7.0 - 0.5);
        places.push_back({middle.x + at * along.x, middle.y + at * along.y});
    }
    const double area = 2.0 * radius * length + 3.14159 * radius * radius;
    const Count found = count(places, radius);
    CHECK(static_cast<double>(found.points) == Approx(area / (square * square)).margin(1.0));
}

TEST_CASE("points for a thin stroke are spread along it", "[static]") {
    const Count found = count({{74.0, 12.0}, {74.0, 136.0}}, 0.25);
    CHECK(found.points >= 15);
    CHECK(found.rows == found.points);
}

TEST_CASE("a point without an edge is a disc", "[static]") {
    size_t points = 0;
    for (int i = 0; i < 200; ++i)
        points += count({{20.0 + 0.5 * i, 30.0 + 0.37 * i}}, 0.8).points;
    CHECK(static_cast<double>(points) ==
          Approx(200.0 * 3.14159 * 0.8 * 0.8 / (square * square)).margin(14.0));
}

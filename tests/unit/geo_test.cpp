// The local metric plane agrees with PROJ's, and rasters come onto it exactly.

#include "error_kind.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "decalgl/core/error.h"
#include "decalgl/geo/geographic_raster.h"
#include "decalgl/geo/local_plane.h"

using namespace decalgl;
using test::kind_of;

namespace {

constexpr float hole = std::numeric_limits<float>::quiet_NaN();

struct KnownPoint {
    double centre_longitude, centre_latitude, longitude, latitude, x, y;
};

// From pyproj 3.7.2 (PROJ 9.5.1): EPSG:4326 to "+proj=tmerc +lat_0=... +lon_0=... +k=1 +datum=WGS84".
constexpr KnownPoint known_points[] = {
    {-157.775, 21.335, -157.9, 21.42, -12959.603673605217, 9416.53014315703},
    {-157.775, 21.335, -157.65, 21.25, 12974.543864534864, -9406.142666036543},
    {-157.775, 21.335, -156.0, 20.0, 185771.49769089633, -146817.1463294244},
    {-157.775, 21.335, -150.0, 40.0, 664291.0642515946, 2098430.613206229},
    {-157.775, 21.335, -120.0, 60.0, 2023375.2302446212, 4904459.180300843},
    {8.54, 47.37, 8.55, 47.36, 755.4363317074329, -1111.731086647467},
    {8.54, 47.37, 7.4, 46.9, -86865.10410359863, -51620.51033012398},
    {8.54, 47.37, 10.0, -30.0, 140877.64920760845, -8569392.53005247},
    {179.9, -17.0, -179.9, -17.1, 21285.875289039657, -11077.903928863581},
    {179.9, -17.0, 179.5, -16.5, -42705.95486696383, 55290.944503374405},
    {0.0, 90.0, 30.0, 89.0, 55845.51468967768, -96732.17988640098},
    {0.0, 90.0, 0.0, 80.0, 0.0, -1116825.857375851},
};
constexpr double micrometre = 1e-6;

double ramp_at(double longitude, double latitude) {
    return 300.0 * longitude - 170.0 * latitude;
}

/// Heights rise evenly along both axes; the rows run from north to south unless the step is above 0.
GeographicRaster ramp(double longitude, double latitude, double longitude_step, double latitude_step) {
    GeographicRaster raster;
    raster.rows = 50;
    raster.columns = 70;
    raster.longitude = longitude;
    raster.latitude = latitude;
    raster.longitude_step = longitude_step;
    raster.latitude_step = latitude_step;
    for (int row = 0; row < raster.rows; ++row) {
        for (int column = 0; column < raster.columns; ++column) {
            raster.heights.push_back(static_cast<float>(ramp_at(
                longitude + column * longitude_step - longitude, latitude + row * latitude_step - latitude)));
        }
    }
    return raster;
}

int count_holes(const Heightfield& heightfield) {
    int count = 0;
    for (const float height : heightfield.heights()) {
        count += std::isnan(height) ? 1 : 0;
    }
    return count;
}

}  // namespace

TEST_CASE("the local plane is PROJ's transverse Mercator, both ways") {
    for (const KnownPoint& known : known_points) {
        const LocalPlane plane(known.centre_longitude, known.centre_latitude);
        const glm::dvec2 metres = plane.forward({known.longitude, known.latitude});
        CHECK(metres.x == Approx(known.x).margin(micrometre).epsilon(0.0));
        CHECK(metres.y == Approx(known.y).margin(micrometre).epsilon(0.0));
        const glm::dvec2 degrees = plane.inverse({known.x, known.y});
        CHECK(std::remainder(degrees.x - known.longitude, 360.0) == Approx(0.0).margin(1e-11));
        CHECK(std::abs(degrees.x - known.centre_longitude) <= 180.0);
        CHECK(degrees.y == Approx(known.latitude).margin(1e-11).epsilon(0.0));
    }
}

TEST_CASE("the plane's centre is its origin, rounded where asked for") {
    CHECK(glm::length(LocalPlane(8.54, 47.37).forward({8.54, 47.37})) < micrometre);
    const LocalPlane plane = LocalPlane::around(202.22503, 21.33496);
    CHECK(plane.longitude() == Approx(-157.7750));
    CHECK(plane.latitude() == 21.335);
    CHECK(kind_of([] { LocalPlane(0.0, 90.1); }) == ErrorKind::crs);
    CHECK(kind_of([] { LocalPlane(std::nan(""), 0.0); }) == ErrorKind::crs);
}

TEST_CASE("what is no place on the globe has no position on the plane") {
    const LocalPlane plane(8.54, 47.37);
    for (const glm::dvec2 nowhere :
         {glm::dvec2(8.0, 90.5), glm::dvec2(std::nan(""), 0.0), glm::dvec2(0.0, -INFINITY)}) {
        CHECK(std::isnan(plane.forward(nowhere).x));
        CHECK(std::isnan(plane.forward(nowhere).y));
    }
    CHECK(std::isnan(plane.inverse({INFINITY, 0.0}).x));
}

TEST_CASE("projecting arrays gives the same bits as projecting points, whatever the threads") {
    const LocalPlane plane(-157.775, 21.335);
    std::vector<double> degrees;
    for (int i = 0; i < 10001; ++i) {
        degrees.push_back(-157.9 + 2.5e-5 * i);
        degrees.push_back(21.42 - 1.7e-5 * i);
    }
    std::vector<double> expected;
    for (std::size_t i = 0; i < degrees.size(); i += 2) {
        const glm::dvec2 metres = plane.forward({degrees[i], degrees[i + 1]});
        expected.insert(expected.end(), {metres.x, metres.y});
    }
    for (const unsigned threads : {1U, 3U}) {
        std::vector<double> metres(degrees.size());
        plane.forward(degrees, metres, threads);
        CHECK(metres == expected);
        plane.inverse(metres, metres, threads);
        double farthest = 0.0;
        for (std::size_t i = 0; i < degrees.size(); ++i) {
            farthest = std::max(farthest, std::abs(metres[i] - degrees[i]));
        }
        CHECK(farthest < 1e-12);
    }
    std::vector<double> short_one(3);
    CHECK(kind_of([&] { plane.forward(short_one, short_one); }) == ErrorKind::input);
    CHECK(kind_of([&] { plane.forward(degrees, short_one); }) == ErrorKind::input);
}

TEST_CASE("a ramp in degrees stays a ramp on the plane") {
    // Northern rows first; southern rows first and across the antimeridian.
    for (const GeographicRaster& raster : {ramp(8.2, 47.6, 0.01, -0.01), ramp(179.6, -17.3, 0.01, 0.01)}) {
        const LocalPlane plane = plane_around(raster);
        const Heightfield warped = warp_to_plane(raster, plane);
        double largest = 0.0;
        int compared = 0;
        for (int row = 0; row < warped.rows(); ++row) {
            for (int column = 0; column < warped.columns(); ++column) {
                const glm::dvec2 degrees =
                    plane.inverse({warped.x0() + column * warped.dx(), warped.y0() - row * warped.dy()});
                const double height = warped.height(row, column);
                if (!std::isnan(height)) {
                    const double turned = std::remainder(degrees.x - raster.longitude, 360.0);
                    largest =
                        std::max(largest, std::abs(height - ramp_at(turned, degrees.y - raster.latitude)));
                    ++compared;
                }
            }
        }
        // A position within 1/1000 of a sample counts as on it: 3 m and 1.7 m lie between neighbours.
        CHECK(largest < 1e-3 * (3.0 + 1.7));
        CHECK(compared > 9 * warped.rows() * warped.columns() / 10);
        CHECK(warped.dx() ==
              Approx(0.01 * 111320.0 * std::cos(plane.latitude() * 0.017453292519943295)).epsilon(0.02));
        CHECK(warped.dy() == Approx(0.01 * 111000.0).epsilon(0.02));
    }
}

TEST_CASE("the plane's grid is the one of the Python package") {
    GeographicRaster raster;
    raster.rows = 5;
    raster.columns = 6;
    raster.longitude = 8.5005;
    raster.latitude = 47.3995;
    raster.longitude_step = 0.001;
    raster.latitude_step = -0.001;
    raster.heights.assign(30, 7.0F);
    const Heightfield warped = warp_to_plane(raster, plane_around(raster));
    // decalgl.Terrain.from_array(z, (0.001, 0, 8.5, 0, -0.001, 47.4), "EPSG:4326")
    CHECK(warped.rows() == 5);
    CHECK(warped.columns() == 6);
    CHECK(warped.x0() == Approx(-188.7323629475128).margin(micrometre).epsilon(0.0));
    CHECK(warped.y0() == Approx(222.360252768383).margin(micrometre).epsilon(0.0));
    CHECK(warped.dx() == Approx(75.49294517900512).margin(micrometre).epsilon(0.0));
    CHECK(warped.dy() == Approx(111.17934924022553).margin(micrometre).epsilon(0.0));
    CHECK(count_holes(warped) == 0);
}

TEST_CASE("a hole never shrinks, and does not spread beyond its neighbours") {
    GeographicRaster raster = ramp(8.2, 47.6, 0.01, -0.01);
    const LocalPlane plane = plane_around(raster);
    const int outside = count_holes(warp_to_plane(raster, plane));
    raster.heights[25 * 70 + 35] = hole;
    const int holes = count_holes(warp_to_plane(raster, plane)) - outside;
    CHECK(holes >= 1);
    CHECK(holes <= 9);
    raster.heights.assign(raster.heights.size(), hole);
    const Heightfield empty = warp_to_plane(raster, plane);
    CHECK(count_holes(empty) == empty.rows() * empty.columns());
}

TEST_CASE("rasters that do not fit are refused with a reason") {
    GeographicRaster raster = ramp(8.2, 47.6, 0.01, -0.01);
    const LocalPlane plane = plane_around(raster);
    CHECK(kind_of([&] { warp_to_plane(raster, plane, {100, 1}); }) == ErrorKind::memory);
    GeographicRaster steps = raster;
    steps.longitude_step = 0.0;
    CHECK(kind_of([&] { warp_to_plane(steps, plane); }) == ErrorKind::input);
    GeographicRaster few = raster;
    few.heights.pop_back();
    CHECK(kind_of([&] { warp_to_plane(few, plane); }) == ErrorKind::input);
    GeographicRaster globe = raster;
    globe.longitude = -180.0;
    globe.longitude_step = 360.0 / 70.0;
    CHECK(kind_of([&] { warp_to_plane(globe, plane_around(globe)); }) == ErrorKind::crs);
    GeographicRaster beyond = raster;
    beyond.latitude_step = 5.0;
    CHECK(kind_of([&] { warp_to_plane(beyond, plane); }) == ErrorKind::crs);
}

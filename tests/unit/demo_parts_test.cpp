// What the demo reads: the packed data as Python reads it, and damaged files as errors.

#include "error_kind.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <string>

#include "app/geotiff.h"
#include "app/gzip.h"
#include "app/isolines.h"
#include "app/topojson.h"
#include "decalgl/core/error.h"

using namespace decalgl;
using test::kind_of;
namespace fs = std::filesystem;

namespace {

const fs::path data = DECALGL_DEMO_DATA;

/// A file that goes away with the object.
class TemporaryFile {
public:
    explicit TemporaryFile(const std::string& bytes) {
        static std::mt19937_64 random{std::random_device{}()};
        path_ = fs::temp_directory_path() / ("decalgl_" + std::to_string(random()));
        std::ofstream(path_, std::ios::binary) << bytes;
    }
    ~TemporaryFile() { fs::remove(path_); }
    const fs::path& path() const { return path_; }

private:
    fs::path path_;
};

std::string bytes_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

PolygonTable parse(const std::string& arcs, const std::string& geometries) {
    return parse_topojson(
        R"({"type":"Topology","transform":{"scale":[0.5,2],"translate":[10,20]},"objects":{"map":)"
        R"({"type":"GeometryCollection","geometries":[)" +
            geometries + R"(]}},"arcs":[)" + arcs + "]}",
        "map", "kind", "test");
}

std::string polygon(const std::string& rings) {
    return R"({"type":"Polygon","properties":{"kind":"a"},"arcs":)" + rings + "}";
}

// Two halves of a square, from its south west to its north east and back.
const char* const two_arcs = "[[0,0],[2,0],[0,2]],[[2,2],[-2,0],[0,-2]]";

}  // namespace

TEST_CASE("the packed terrain is read as GDAL reads it") {
    const GeographicRaster raster = read_geotiff(data / "dem.tif");
    CHECK(raster.rows == 612);
    CHECK(raster.columns == 900);
    CHECK(raster.longitude == Approx(-157.9 + 0.5 / 3600.0).epsilon(1e-14));
    CHECK(raster.latitude == Approx(21.42 - 0.5 / 3600.0).epsilon(1e-14));
    const Heightfield warped = warp_to_plane(raster, plane_around(raster));
    int holes = 0;
    double sum = 0.0;
    for (const float height : warped.heights()) {
        std::isnan(height) ? ++holes : sum += height;
    }
    // decalgl.Terrain.open("dem.tif") has this grid, as many missing samples and the same sum.
    CHECK(warped.rows() == 612);
    CHECK(warped.columns() == 901);
    CHECK(warped.dx() == Approx(28.80025675925069).margin(1e-9).epsilon(0.0));
    CHECK(warped.dy() == Approx(30.764378021346214).margin(1e-9).epsilon(0.0));
    CHECK(holes == 2949);
    CHECK(sum == Approx(65452406.2597).margin(0.01).epsilon(0.0));
}

TEST_CASE("the packed land cover has every polygon, hole and vertex") {
    const fs::path path = data / "landcover.topojson.gz";
    const PolygonTable cover =
        parse_topojson(read_gzip(path, 1 << 24), "landcover", "material", path.string());
    CHECK(cover.values.size() == 3582);
    CHECK(cover.part_offsets.size() == 4164 + 1);
    CHECK(cover.coordinates.size() == 2 * 126341);
    CHECK(cover.feature_offsets.back() == 4164);
}

TEST_CASE("rings follow their arcs forwards and backwards") {
    const PolygonTable table = parse(two_arcs, polygon("[[0,1]]") + "," + polygon("[[-2,-1]]"));
    CHECK(table.coordinates ==
          std::vector<double>{10, 20, 11, 20, 11, 24, 10, 24, 10, 20, 10, 24, 11, 24, 11, 20});
    CHECK(table.part_offsets == std::vector<std::int64_t>{0, 4, 8});
    CHECK(table.feature_offsets == std::vector<std::int64_t>{0, 1, 2});
    const PolygonTable members = parse(two_arcs, R"({"type":"MultiPolygon","properties":{"kind":"b"},)"
                                                 R"("arcs":[[[0,1]],[[0,1],[0,1]]]})");
    CHECK(members.feature_offsets == std::vector<std::int64_t>{0, 3});
    CHECK(members.values == std::vector<std::string>{"b"});
}

TEST_CASE("damaged topologies are refused, whatever is wrong with them") {
    const std::string ring = polygon("[[0,1]]");
    const std::array<std::array<std::string, 2>, 16> cases{{
        {two_arcs, polygon("[[0,2]]")},
        {two_arcs, polygon("[[0,-3]]")},
        {two_arcs, polygon("[[0,9223372036854775807]]")},
        {two_arcs, polygon("[[0,18446744073709551615]]")},
        {two_arcs, polygon("[[0]]")},
        {two_arcs, polygon("[[0,0]]")},
        {two_arcs, polygon("[[]]")},
        {two_arcs, polygon("[0,1]")},
        {two_arcs, polygon("[[0.5]]")},
        {two_arcs, polygon("{\"a\":[0,1]}")},
        {two_arcs, R"({"type":"Point","properties":{"kind":"a"},"arcs":[]})"},
        {two_arcs, R"({"type":"Polygon","properties":{"kind":1},"arcs":[[0,1]]})"},
        {two_arcs, R"({"type":"Polygon","properties":null,"arcs":[[0,1]]})"},
        {"[[0,0]]", ring},
        {"[[0,0],[4503599627370496,0],[1,0]]", ring},
        {"[[0],[1]]", ring},
    }};
    for (const auto& [arcs, geometry] : cases) {
        INFO(arcs << " " << geometry);
        CHECK(kind_of([&, &lines = arcs, &shape = geometry] { parse(lines, shape); }) == ErrorKind::file);
    }
    for (const std::string& text :
         {std::string(), std::string("[]"), std::string("{\"arcs\":"), std::string(100000, '['),
          std::string("{\"transform\":{\"scale\":[]}}")}) {
        CHECK(kind_of([&] { parse_topojson(text, "map", "kind", "test"); }) == ErrorKind::file);
    }
}

TEST_CASE("gzip files that are missing, damaged or too large are refused") {
    const std::string whole = bytes_of(data / "landcover.topojson.gz");
    CHECK(kind_of([] { read_gzip(data / "none.gz", 100); }) == ErrorKind::file);
    CHECK(kind_of([] { read_gzip(data, 100); }) == ErrorKind::file);
    CHECK(kind_of([] { read_gzip(data / "README.md", 1 << 20); }) == ErrorKind::file);
    CHECK(kind_of([] { read_gzip(data / "landcover.topojson.gz", 1000); }) == ErrorKind::memory);
    CHECK(kind_of([&] { read_gzip(TemporaryFile(whole.substr(0, 100000)).path(), 1 << 24); }) ==
          ErrorKind::file);
    CHECK(kind_of([&] { read_gzip(TemporaryFile("").path(), 1 << 24); }) == ErrorKind::file);
}

TEST_CASE("terrain files that are missing or damaged are refused") {
    const std::string whole = bytes_of(data / "dem.tif");
    CHECK(kind_of([] { read_geotiff(data / "none.tif"); }) == ErrorKind::file);
    CHECK(kind_of([] { read_geotiff(data / "README.md"); }) == ErrorKind::file);
    for (const std::size_t size : {std::size_t{0}, std::size_t{8}, std::size_t{200}, whole.size() / 2}) {
        CHECK(kind_of([&] { read_geotiff(TemporaryFile(whole.substr(0, size)).path()); }) == ErrorKind::file);
    }
}

TEST_CASE("changed bytes in a terrain's header end in a terrain or an error") {
    const std::string whole = bytes_of(data / "dem.tif");
    std::mt19937 random(7);
    int errors = 0;
    for (int round = 0; round < 300; ++round) {
        std::string changed = whole;
        changed[random() % 420] = static_cast<char>(random());
        try {
            const GeographicRaster raster = read_geotiff(TemporaryFile(changed).path());
            CHECK(raster.heights.size() ==
                  static_cast<std::size_t>(raster.rows) * static_cast<std::size_t>(raster.columns));
        } catch (const Error&) {
            ++errors;
        }
    }
    CHECK(errors > 50);
}

TEST_CASE("isolines are whole and keep the higher ground on their left") {
    // A pyramid whose top is in the middle of 5 x 5 samples.
    std::vector<float> heights;
    for (int row = 0; row < 5; ++row) {
        for (int column = 0; column < 5; ++column) {
            heights.push_back(
                static_cast<float>(10 * (2 - std::max(std::abs(row - 2), std::abs(column - 2)))));
        }
    }
    const Heightfield pyramid(heights, 5, 5, 100.0, 50.0, 1.0, 2.0);
    Polylines lines;
    append_isolines(pyramid, 5.0, lines);
    REQUIRE(lines.offsets.size() == 2);
    const std::size_t count = lines.coordinates.size() / 2;
    CHECK(lines.coordinates[0] == lines.coordinates[2 * count - 2]);
    CHECK(lines.coordinates[1] == lines.coordinates[2 * count - 1]);
    double doubled_area = 0.0;
    for (std::size_t i = 0; i + 1 < count; ++i) {
        const double* point = &lines.coordinates[2 * i];
        doubled_area += point[0] * point[3] - point[2] * point[1];
    }
    CHECK(doubled_area > 2.0 * 2.0 * 4.0);  // counterclockwise around the top

    append_isolines(pyramid, 25.0, lines);
    CHECK(lines.offsets.size() == 2);
    // An open line from border to border, and none through a hole.
    Polylines open;
    append_isolines(Heightfield({0, 0, 0, 1, 1, 1}, 2, 3, 0.0, 0.0, 1.0, 1.0), 0.25, open);
    CHECK(open.coordinates == std::vector<double>{2.0, -0.25, 1.0, -0.25, 0.0, -0.25});
    Polylines none;
    append_isolines(Heightfield({0, NAN, 0, 1, 1, 1}, 2, 3, 0.0, 0.0, 1.0, 1.0), 0.25, none);
    CHECK(none.offsets.size() == 1);
}

TEST_CASE("isolines at a saddle go around the high corners or the low ones, as the middle says") {
    const auto lines_at = [](double level) {
        Polylines lines;
        append_isolines(Heightfield({4, 0, 0, 4}, 2, 2, 0.0, 0.0, 1.0, 1.0), level, lines);
        return lines;
    };
    CHECK(lines_at(1.0).offsets.size() == 3);
    CHECK(lines_at(3.0).offsets.size() == 3);
    // Below the middle's height the lines cut off the low corners, above it the high ones.
    const std::vector<double> low = lines_at(1.0).coordinates;
    CHECK(std::abs(low[0] - low[2]) == Approx(0.25));
    const std::vector<double> high = lines_at(3.0).coordinates;
    CHECK(std::abs(high[0] - high[2]) == Approx(0.25));
}

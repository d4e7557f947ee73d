// The shader functions of the terrain and of rays, against double precision on the CPU.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <set>

#include "frame/view_setup.h"
#include "one_pixel.h"

using namespace decalgl;
using glm::vec4;
using test::OnePixel;

namespace {

constexpr double radians = 3.14159265358979323846 / 180.0;

struct Ray {
    glm::dvec3 origin;
    glm::dvec3 direction;
};

// Through pixels (x, y) from the picture's centre, y upwards; the depth counts from the eye.
Ray ray_through(const Camera& camera, int height, double x, double y) {
    const CameraBasis basis = basis_of(camera);
    const double half =
        camera.orthographic() ? 0.5 * camera.view_height : std::tan(0.5 * camera.fov * radians);
    const glm::dvec3 aside = (2.0 * half / height) * (x * basis.right + y * basis.up);
    if (camera.orthographic()) {
        return {camera.eye + aside, basis.forward};
    }
    return {camera.eye, basis.forward + aside};
}

glm::dvec3 on_plane(const Ray& ray, glm::dvec3 point, glm::dvec3 normal) {
    return ray.origin +
           (glm::dot(normal, point - ray.origin) / glm::dot(normal, ray.direction)) * ray.direction;
}

}  // namespace

TEST_CASE("footprint is how the surface moves from pixel to pixel") {
    Camera camera;
    camera.eye = {120.0, -340.0, 260.0};
    camera.target = {10.0, 20.0, 30.0};
    camera.view_height = GENERATE(0.0, 400.0);
    const double base_depth = GENERATE(0.0, 250.0);
    const int width = 640, height = 360;
    const Heightfield terrain = Heightfield::flat({-1000.0, -1000.0, 1000.0, 1000.0}, 0.0F);
    const ViewBlock view =
        make_view_block(camera, width, height, terrain, PositionGrid::around(terrain.bounds()), base_depth);
    OnePixel shader({"shared/ray.glsl"}, 2, R"(
        mat2 foot = footprint(input0.xy, input1.xy, input0.z);
        result = vec4(foot[0], foot[1]);
    )");
    std::mt19937 generator(1);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    std::vector<vec4> values;
    std::vector<glm::dmat2> expected;
    while (expected.size() < 500) {
        const double x = 0.5 * width * unit(generator), y = 0.5 * height * unit(generator);
        const glm::dvec2 slope(unit(generator), unit(generator));
        const glm::dvec3 normal(-slope.x, -slope.y, 1.0);
        const Ray ray = ray_through(camera, height, x, y);
        if (glm::dot(normal, ray.direction) > -0.2) {
            continue;
        }
        const double depth = 400.0 + 100.0 * unit(generator);
        const glm::dvec3 hit = ray.origin + depth * ray.direction;
        const double step = 1e-3;
        const glm::dvec3 right = on_plane(ray_through(camera, height, x + step, y), hit, normal) - hit;
        const glm::dvec3 up = on_plane(ray_through(camera, height, x, y + step), hit, normal) - hit;
        values.insert(values.end(), {vec4(x, y, depth - base_depth, 0), vec4(slope, 0, 0)});
        expected.push_back(glm::dmat2(glm::dvec2(right), glm::dvec2(up)) / step);
    }
    const std::vector<vec4> results = shader.run(values, view);
    for (size_t i = 0; i < results.size(); ++i) {
        const double size = glm::length(expected[i][0]) + glm::length(expected[i][1]);
        REQUIRE(std::abs(double(results[i].x) - expected[i][0].x) < 1e-4 * size);
        REQUIRE(std::abs(double(results[i].y) - expected[i][0].y) < 1e-4 * size);
        REQUIRE(std::abs(double(results[i].z) - expected[i][1].x) < 1e-4 * size);
        REQUIRE(std::abs(double(results[i].w) - expected[i][1].y) < 1e-4 * size);
    }
}

TEST_CASE("positions survive packing, negative blocks and tiny offsets included") {
    OnePixel shader({"shared/position.glsl"}, 1, R"(
        Position position = unpack_position(pack_position(Position(ivec2(input0.xy), input0.zw)));
        result = vec4(vec2(position.block), position.offset);
        if (is_sky(position)) result = vec4(-1.0);
    )");
    const std::vector<vec4> values{{0, 0, 0, 0}, {-1, -8388607, 31.999F, 1e-30F}, {8388607, 5, 1e-6F, 16}};
    CHECK(shader.run(values) == values);
    OnePixel sky({"shared/position.glsl"}, 1, R"(
        result.x = float(is_sky(unpack_position(uvec4(uint(sky_block), 0u, 0u, 0u))));
    )");
    CHECK(sky.run({{0, 0, 0, 0}})[0].x == 1.0F);
}

// Rows (or columns) of samples on one side of a tile: that of a vertex at (64, i) or (0, i), or the transpose.
std::vector<int> side_samples(OnePixel& shader, glm::ivec2 tile, int level, glm::ivec4 neighbours,
                              glm::ivec2 samples, int side, bool transposed) {
    shader.program().set("tile_sample", tile);
    shader.program().set("tile_level", level);
    shader.program().set("neighbour_levels", neighbours);
    ViewBlock view{};
    view.samples = {samples.x, samples.y, 0, 0};
    std::vector<vec4> values;
    const int quads = 64 >> level;
    for (int i = 0; i <= quads; ++i) {
        values.push_back(transposed ? vec4(i, side * quads, 0, 0) : vec4(side * quads, i, 0, 0));
    }
    std::vector<int> found;
    for (const vec4& result : shader.run(values, view)) {
        found.push_back(static_cast<int>(transposed ? result.x : result.y));
        CHECK(static_cast<int>(transposed ? result.y : result.x) ==
              std::min((transposed ? tile.y : tile.x) + 64 * side, (transposed ? samples.y : samples.x) - 1));
    }
    return found;
}

TEST_CASE("neighbouring tiles of any two levels have the same edge") {
    const bool transposed = GENERATE(false, true);
    const int across = GENERATE(1000, 80, 129);  // samples along the seam: whole tiles, and ones cut short
    const int beyond = GENERATE(1000, 70);
    OnePixel shader({"terrain/mesh.glsl"}, 1, "result.xy = vec2(mesh_sample(ivec2(input0.xy)));\n");
    const glm::ivec2 samples = transposed ? glm::ivec2(across, beyond) : glm::ivec2(beyond, across);
    for (int start = 0; start < across - 1 && start < 200; start += 64) {
        for (int first = 0; first <= 6; ++first) {
            for (int second = 0; second <= 6; ++second) {
                // west, east, north, south
                const glm::ivec4 of_first =
                    transposed ? glm::ivec4(2, 5, 1, second) : glm::ivec4(1, second, 2, 5);
                const glm::ivec4 of_second =
                    transposed ? glm::ivec4(3, 0, first, 4) : glm::ivec4(first, 4, 3, 0);
                const glm::ivec2 tile = transposed ? glm::ivec2(start, 0) : glm::ivec2(0, start);
                const glm::ivec2 next = transposed ? glm::ivec2(start, 64) : glm::ivec2(64, start);
                const auto one = side_samples(shader, tile, first, of_first, samples, 1, transposed);
                const auto other = side_samples(shader, next, second, of_second, samples, 0, transposed);
                INFO("levels " << first << " and " << second << " from sample " << start);
                CHECK(std::is_sorted(one.begin(), one.end()));
                CHECK(std::is_sorted(other.begin(), other.end()));
                CHECK(std::set<int>(one.begin(), one.end()) == std::set<int>(other.begin(), other.end()));
                CHECK(one.front() == start);
                CHECK(one.back() == std::min(start + 64, across - 1));
            }
        }
    }
}

// From a camera to uniforms and tiles: nothing visible is culled, nothing but the view decides, no digit is lost.
#include "frame/view_setup.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <random>

#include "decalgl/core/error.h"

using namespace decalgl;

namespace {

constexpr double radians = 3.14159265358979323846 / 180.0;
constexpr int width = 320;
constexpr int height = 180;

Heightfield hills(double x0 = -5000.0, double y0 = 4000.0) {
    const int32_t rows = 400, columns = 500;
    std::vector<float> heights;
    for (int32_t row = 0; row < rows; ++row) {
        for (int32_t column = 0; column < columns; ++column) {
            const double ripple = column > 300 ? 0.3 * ((row * 7 + column * 13) % 11) : 0.0;
            heights.push_back(
                static_cast<float>(300.0 * std::sin(0.02 * column) * std::cos(0.03 * row) + ripple));
        }
    }
    return Heightfield(heights, rows, columns, x0, y0, 20.0, 20.0);
}

class Cameras {
public:
    explicit Cameras(unsigned seed) : generator_(seed) {}

    Camera next() {
        Camera camera;
        camera.eye = {real(-9000, 9000), real(-9000, 9000), std::exp2(real(3.0, 15.0))};
        camera.target = {real(-4000, 4000), real(-3000, 3000), real(-300, 300)};
        camera.fov = real(1.0, 150.0);
        camera.view_height = real(0.0, 1.0) < 0.3 ? std::exp2(real(4.0, 14.0)) : 0.0;
        return camera;
    }

    double real(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(generator_);
    }

private:
    std::mt19937 generator_;
};

struct Projected {
    double x;  // -1 to 1 across the picture
    double y;
    double depth;
};

Projected project(const Camera& camera, glm::dvec3 point) {
    const CameraBasis basis = basis_of(camera);
    const glm::dvec3 relative = point - camera.eye;
    const double depth = glm::dot(relative, basis.forward);
    const double half =
        camera.orthographic() ? 0.5 * camera.view_height : std::tan(0.5 * camera.fov * radians) * depth;
    return {glm::dot(relative, basis.right) / (half * width / height), glm::dot(relative, basis.up) / half,
            depth};
}

bool in_picture(const Projected& at) {
    return at.depth > 0.0 && std::abs(at.x) <= 1.0 && std::abs(at.y) <= 1.0;
}

glm::dvec3 sample_position(const Heightfield& field, int32_t column, int32_t row) {
    return {field.x0() + column * field.dx(), field.y0() - row * field.dy(),
            static_cast<double>(field.height(row, column))};
}

bool same(const std::vector<VisibleTile>& a, const std::vector<VisibleTile>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const VisibleTile& x, const VisibleTile& y) {
        return x.tile == y.tile && x.level == y.level && x.neighbour_levels == y.neighbour_levels;
    });
}

}  // namespace

TEST_CASE("no tile with a visible sample is culled, and nothing visible lies before the base") {
    const Heightfield field = hills();
    const TerrainTiles tiles = TerrainTiles::over(field, 1);
    Cameras cameras(1);
    int partly = 0;
    for (int view = 0; view < 300; ++view) {
        const Camera camera = cameras.next();
        const auto visible = select_tiles(tiles, field, camera, width, height, 1.0);
        const double nearest = nearest_depth(visible, field, camera);
        CHECK(nearest == static_cast<double>(static_cast<float>(nearest)));
        std::vector<bool> chosen(tiles.tiles.size());
        for (const VisibleTile& one : visible) {
            chosen[static_cast<size_t>(one.tile - tiles.tiles.data())] = true;
        }
        for (int32_t row = 0; row < field.rows(); row += 3) {
            for (int32_t column = 0; column < field.columns(); column += 3) {
                const Projected at = project(camera, sample_position(field, column, row));
                if (in_picture(at)) {
                    const int32_t tile = std::min(row / 64, tiles.rows - 1) * tiles.columns +
                                         std::min(column / 64, tiles.columns - 1);
                    REQUIRE(chosen[static_cast<size_t>(tile)]);
                    REQUIRE(at.depth >= nearest);
                }
            }
        }
        partly += !visible.empty() && visible.size() < tiles.tiles.size();
    }
    CHECK(partly > 100);
}

TEST_CASE("levels depend on the view alone and differ by one between neighbours") {
    const Heightfield field = hills();
    const TerrainTiles tiles = TerrainTiles::over(field, 1);
    Cameras cameras(2);
    std::map<int, int> levels;
    for (int view = 0; view < 200; ++view) {
        const Camera camera = cameras.next();
        const double terrain_error = std::exp2(cameras.real(-3.0, 5.0));
        const auto visible = select_tiles(tiles, field, camera, width, height, terrain_error);
        select_tiles(tiles, field, cameras.next(), width, height, 3.0);
        REQUIRE(same(select_tiles(tiles, field, camera, width, height, terrain_error), visible));

        std::map<size_t, const VisibleTile*> by_place;
        for (const VisibleTile& one : visible) {
            by_place[static_cast<size_t>(one.tile - tiles.tiles.data())] = &one;
            ++levels[one.level];
        }
        for (const auto& [place, one] : by_place) {
            const auto columns = static_cast<size_t>(tiles.columns);
            const auto check = [&](bool there, size_t neighbour, int stated) {
                if (!there) {
                    return;
                }
                REQUIRE(std::abs(stated - one->level) <= 1);
                if (by_place.count(neighbour) != 0) {
                    REQUIRE(by_place[neighbour]->level == stated);
                }
            };
            check(place % columns > 0, place - 1, one->neighbour_levels.x);
            check(place % columns + 1 < columns, place + 1, one->neighbour_levels.y);
            check(place >= columns, place - columns, one->neighbour_levels.z);
            check(place + columns < tiles.tiles.size(), place + columns, one->neighbour_levels.w);
        }
    }
    CHECK(levels.size() >= 4);  // the test has seen fine tiles and coarse ones
}

TEST_CASE("a level's error stays below what is asked for, in every corner of the picture") {
    const Heightfield field = hills();
    const TerrainTiles tiles = TerrainTiles::over(field, 1);
    Cameras cameras(3);
    for (int view = 0; view < 200; ++view) {
        const Camera camera = cameras.next();
        const double terrain_error = 2.0;
        for (const VisibleTile& one : select_tiles(tiles, field, camera, width, height, terrain_error)) {
            const auto error = static_cast<double>(one.tile->error[static_cast<size_t>(one.level)]);
            for (int32_t row = one.tile->row; row <= std::min(one.tile->row + 64, field.rows() - 1);
                 row += 8) {
                for (int32_t c = one.tile->column; c <= std::min(one.tile->column + 64, field.columns() - 1);
                     c += 8) {
                    const glm::dvec3 point = sample_position(field, c, row);
                    const Projected at = project(camera, point);
                    if (!in_picture(at)) {
                        continue;
                    }
                    const Projected off = project(camera, point + glm::dvec3(0, 0, 1e-3 * error));
                    const double pixels =
                        1e3 * std::hypot((off.x - at.x) * 0.5 * width, (off.y - at.y) * 0.5 * height);
                    REQUIRE(pixels <= terrain_error * 1.01);
                }
            }
        }
    }
}

TEST_CASE("full detail draws every sample") {
    const Heightfield field = hills();
    const TerrainTiles tiles = TerrainTiles::over(field, 1);
    Cameras cameras(4);
    for (int view = 0; view < 50; ++view) {
        for (const VisibleTile& one : select_tiles(tiles, field, cameras.next(), width, height, 0.0)) {
            REQUIRE(one.level == 0);
            REQUIRE(one.neighbour_levels == glm::ivec4(0));
        }
    }
}

TEST_CASE("the view block holds the base and the rays without losing digits") {
    const double far = GENERATE(0.0, 1.0e7);
    const Heightfield field = hills(far - 5000.0, 4000.0 - far);
    const TerrainTiles tiles = TerrainTiles::over(field, 1);
    const PositionGrid positions = PositionGrid::around(field.bounds());
    Cameras cameras(5);
    for (int view = 0; view < 200; ++view) {
        Camera camera = cameras.next();
        camera.eye += glm::dvec3(far, -far, view % 5 == 0 ? 500e3 : 0.0);
        camera.target += glm::dvec3(far, -far, 0.0);
        const auto visible = select_tiles(tiles, field, camera, width, height, 0.0);
        const double depth = nearest_depth(visible, field, camera);
        const ViewBlock block = make_view_block(camera, width, height, field, positions, depth);
        const CameraBasis basis = basis_of(camera);
        const glm::dvec3 base = camera.eye + depth * basis.forward;
        const double reach = glm::length(base - glm::dvec3(far, -far, 0.0)) + 1.0;

        CHECK(block.forward.w == static_cast<float>(depth));
        const double x = positions.origin_x + block.base_block.x * positions.block_size +
                         static_cast<double>(block.base_offset.x);
        const double y = positions.origin_y + block.base_block.y * positions.block_size +
                         static_cast<double>(block.base_offset.y);
        CHECK(std::abs(x - base.x) <= 3e-6);
        CHECK(std::abs(y - base.y) <= 3e-6);
        CHECK(block.base_offset.x >= 0.0F);
        CHECK(static_cast<double>(block.base_offset.x) <= positions.block_size);
        const double column = block.base_sample.x + static_cast<double>(block.base_sample_fraction.x);
        const double row = block.base_sample.y + static_cast<double>(block.base_sample_fraction.y);
        CHECK(std::abs(field.x0() + column * field.dx() - base.x) <= 2e-6);
        CHECK(std::abs(field.y0() - row * field.dy() - base.y) <= 2e-6);
        const double z = static_cast<double>(block.base_sample_fraction.z) +
                         static_cast<double>(block.base_sample_fraction.w);
        CHECK(std::abs(z - base.z) <= 1e-9 * reach);

        // A point of the ray through a pixel lands on that pixel again, by the matrix that draws triangles.
        const double px = cameras.real(-0.5, 0.5) * width, py = cameras.real(-0.5, 0.5) * height;
        const double distance = cameras.real(1.0, 3000.0);
        const glm::dvec3 origin = px * glm::dvec3(block.ray_origin_dx) + py * glm::dvec3(block.ray_origin_dy);
        const glm::dvec3 direction = glm::dvec3(block.ray_direction) +
                                     px * glm::dvec3(block.ray_direction_dx) +
                                     py * glm::dvec3(block.ray_direction_dy);
        const glm::dvec3 relative = origin + distance * direction;
        const Projected at = project(camera, base + relative);
        CHECK(std::abs(at.x * 0.5 * width - px) <= 2e-3);
        CHECK(std::abs(at.y * 0.5 * height - py) <= 2e-3);
        CHECK(std::abs(at.depth - depth - distance) <= 1e-5 * (distance + depth * 1e-2));
        const glm::vec4 clip = block.clip_from_base * glm::vec4(glm::vec3(relative), 1.0F);
        CHECK(std::abs(static_cast<double>(clip.x / clip.w) * 0.5 * width - px) <= 2e-3);
        CHECK(std::abs(static_cast<double>(clip.y / clip.w) * 0.5 * height - py) <= 2e-3);
    }
}

TEST_CASE("depth is reversed, and what is seen lies between the planes") {
    const Heightfield field = hills();
    const TerrainTiles tiles = TerrainTiles::over(field, 1);
    const PositionGrid positions = PositionGrid::around(field.bounds());
    Cameras cameras(6);
    for (int view = 0; view < 200; ++view) {
        const Camera camera = cameras.next();
        const double depth =
            nearest_depth(select_tiles(tiles, field, camera, width, height, 0.0), field, camera);
        const ViewBlock block = make_view_block(camera, width, height, field, positions, depth);
        const glm::dvec3 base = camera.eye + depth * basis_of(camera).forward;
        std::map<double, double> by_depth;
        for (int i = 0; i < 50; ++i) {
            const auto column = static_cast<int32_t>(cameras.real(0, field.columns() - 1));
            const auto row = static_cast<int32_t>(cameras.real(0, field.rows() - 1));
            const glm::dvec3 point = sample_position(field, column, row);
            const Projected at = project(camera, point);
            if (!in_picture(at) || at.depth < 0.01) {
                continue;
            }
            const glm::vec4 clip = block.clip_from_base * glm::vec4(glm::vec3(point - base), 1.0F);
            REQUIRE(clip.w > 0.0F);
            REQUIRE(clip.z >= 0.0F);
            REQUIRE(clip.z <= clip.w);
            by_depth[at.depth] = static_cast<double>(clip.z / clip.w);
        }
        double previous = 1.0;
        for (const auto& [distance, value] : by_depth) {
            REQUIRE(value <= previous + 1e-6);
            previous = value;
        }
    }
}

TEST_CASE("an eye too far from the terrain is refused") {
    const Heightfield field = hills();
    const PositionGrid positions = PositionGrid::around(field.bounds());
    Camera camera;
    camera.eye = {1e15, 0.0, 100.0};
    camera.target = {0.0, 0.0, 0.0};
    try {
        make_view_block(camera, width, height, field, positions, 0.0);
        FAIL("no Error was thrown");
    } catch (const Error& error) {
        CHECK(error.kind() == ErrorKind::input);
    }
}

// Heightfields, their tiles and levels of detail, and their shading, against brute force.
#include "decalgl/terrain/heightfield.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "decalgl/core/error.h"
#include "decalgl/terrain/relief.h"
#include "decalgl/terrain/tiles.h"

using namespace decalgl;

namespace {

constexpr float missing = std::numeric_limits<float>::quiet_NaN();

Heightfield rough(int32_t rows, int32_t columns, unsigned seed = 1) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> height(-30.0F, 80.0F);
    std::vector<float> heights(static_cast<size_t>(rows) * static_cast<size_t>(columns));
    for (float& h : heights) {
        h = height(generator);
    }
    return Heightfield(heights, rows, columns, 1000.0, 2000.0, 3.0, 2.0);
}

// Heights that depend on a sample's column and row.
template <typename Shape>
Heightfield shaped(int32_t rows, int32_t columns, Shape shape) {
    std::vector<float> heights;
    for (int32_t row = 0; row < rows; ++row) {
        for (int32_t column = 0; column < columns; ++column) {
            heights.push_back(static_cast<float>(shape(column, row)));
        }
    }
    return Heightfield(heights, rows, columns, 0.0, 0.0, 1.0, 1.0);
}

// The height of the surface over every step-th sample of a tile (and its last ones), at a place in samples.
double coarse_height(const Heightfield& field, const TerrainTile& tile, int32_t step, double x, double y) {
    const auto cell = [&](double at, int32_t first, int32_t count) {
        const int32_t last = std::min(first + tile_quads, count - 1);
        const auto low = first + static_cast<int32_t>((at - first) / step) * step;
        const int32_t from = std::min(low, last - 1 < first ? first
                                           : low == last    ? std::max(low - step, first)
                                                            : low);
        return std::pair<int32_t, int32_t>(from, std::min(from + step, last));
    };
    const auto [west, east] = cell(x, tile.column, field.columns());
    const auto [north, south] = cell(y, tile.row, field.rows());
    const double u = (x - west) / (east - west), v = (y - north) / (south - north);
    const auto h = [&](int32_t row, int32_t column) {
        return static_cast<double>(field.height(row, column));
    };
    return v > u ? h(north, west) + v * (h(south, west) - h(north, west)) +
                       u * (h(south, east) - h(south, west))
                 : h(north, west) + u * (h(north, east) - h(north, west)) +
                       v * (h(south, east) - h(north, east));
}

}  // namespace

TEST_CASE("a heightfield says where its samples are and refuses what makes none") {
    const Heightfield field = rough(5, 7);
    const Bounds bounds = field.bounds();
    CHECK(bounds.min_x == 1000.0);
    CHECK(bounds.max_x == 1018.0);
    CHECK(bounds.min_y == 1992.0);
    CHECK(bounds.max_y == 2000.0);
    CHECK(field.exaggerated(2.0).height(3, 4) == 2.0F * field.height(3, 4));
    CHECK(std::isnan(Heightfield({1.0F, missing}, 1, 2, 0, 0, 1, 1).exaggerated(3.0).height(0, 1)));

    const auto kind_of = [](auto make) {
        try {
            make();
        } catch (const Error& error) {
            return error.kind();
        }
        FAIL("no Error was thrown");
        return ErrorKind::unsupported;
    };
    const float infinite = std::numeric_limits<float>::infinity();
    CHECK(kind_of([] { Heightfield({1.0F}, 1, 2, 0, 0, 1, 1); }) == ErrorKind::input);
    CHECK(kind_of([] { Heightfield({}, 0, 0, 0, 0, 1, 1); }) == ErrorKind::input);
    CHECK(kind_of([] { Heightfield({1.0F}, 1, 1, 0, 0, 0, 1); }) == ErrorKind::input);
    CHECK(kind_of([] { Heightfield({1.0F}, 1, 1, std::nan(""), 0, 1, 1); }) == ErrorKind::input);
    CHECK(kind_of([&] { Heightfield({infinite}, 1, 1, 0, 0, 1, 1); }) == ErrorKind::input);
    CHECK(kind_of([&] { rough(2, 2).exaggerated(-1.0); }) == ErrorKind::input);
    CHECK(kind_of([] { Heightfield::flat({0, 0, 0, 1}, 0.0F); }) == ErrorKind::input);
}

TEST_CASE("tiles cover the terrain, the last ones cut short") {
    const int32_t rows = GENERATE(1, 2, 64, 65, 66, 130), columns = GENERATE(1, 2, 65, 129, 200);
    const Heightfield field = rough(rows, columns);
    const TerrainTiles tiles = TerrainTiles::over(field, 2);
    CHECK(tiles.rows == (rows - 1 + 63) / 64);
    CHECK(tiles.columns == (columns - 1 + 63) / 64);
    REQUIRE(tiles.tiles.size() == static_cast<size_t>(tiles.rows) * static_cast<size_t>(tiles.columns));
    CHECK(!tiles.has_holes);
    for (const TerrainTile& tile : tiles.tiles) {
        float lowest = field.height(tile.row, tile.column), highest = lowest;
        for (int32_t row = tile.row; row <= std::min(tile.row + 64, rows - 1); ++row) {
            for (int32_t column = tile.column; column <= std::min(tile.column + 64, columns - 1); ++column) {
                lowest = std::min(lowest, field.height(row, column));
                highest = std::max(highest, field.height(row, column));
            }
        }
        CHECK(tile.lowest == lowest);
        CHECK(tile.highest == highest);
    }
}

TEST_CASE("a level's error bounds the distance of its surface everywhere, and is reached") {
    const Heightfield field = rough(100, 150, 3);
    const TerrainTiles tiles = TerrainTiles::over(field, 1);
    std::mt19937 generator(5);
    for (const TerrainTile& tile : tiles.tiles) {
        const int32_t last_row = std::min(tile.row + 64, 99), last_column = std::min(tile.column + 64, 149);
        CHECK(tile.error[0] == 0.0F);
        for (int level = 1; level < tile_levels; ++level) {
            const float bound = tile.error[static_cast<size_t>(level)];
            CHECK(bound >= tile.error[static_cast<size_t>(level - 1)]);
            double worst = 0.0;
            for (int i = 0; i < 3000; ++i) {
                const double x = std::uniform_real_distribution<double>(tile.column, last_column)(generator);
                const double y = std::uniform_real_distribution<double>(tile.row, last_row)(generator);
                const double off = std::abs(coarse_height(field, tile, 1 << level, x, y) -
                                            coarse_height(field, tile, 1, x, y));
                REQUIRE(off <= static_cast<double>(bound) * 1.000001);
                worst = std::max(worst, off);
            }
            CHECK(worst > 0.6 * static_cast<double>(bound));
        }
    }
}

TEST_CASE("planes need no detail, and folds along the diagonal need none either") {
    const auto plane = [](int32_t column, int32_t row) { return 0.25 * column - 0.5 * row; };
    const auto fold = [](int32_t column, int32_t row) { return std::abs(column - row); };
    for (const TerrainTile& tile : TerrainTiles::over(shaped(65, 129, plane), 1).tiles) {
        CHECK(tile.error.back() == 0.0F);
    }
    CHECK(TerrainTiles::over(shaped(65, 65, fold), 1).tiles[0].error.back() == 0.0F);
    const auto other = [](int32_t column, int32_t row) { return std::abs(column + row - 64); };
    CHECK(TerrainTiles::over(shaped(65, 65, other), 1).tiles[0].error.back() == 64.0F);
}

TEST_CASE("tiles with holes keep every sample, and one without any is marked") {
    std::vector<float> heights(65 * 193, 5.0F);
    heights[30 * 193 + 20] = missing;
    for (size_t row = 0; row < 65; ++row) {
        for (size_t column = 64; column <= 128; ++column) {
            heights[row * 193 + column] = missing;
        }
    }
    const TerrainTiles tiles = TerrainTiles::over(Heightfield(heights, 65, 193, 0, 0, 1, 1), 1);
    CHECK(tiles.has_holes);
    REQUIRE(tiles.tiles.size() == 3);
    CHECK(std::isinf(tiles.tiles[0].error[1]));
    CHECK(tiles.tiles[0].lowest == 5.0F);
    CHECK(tiles.tiles[1].lowest > tiles.tiles[1].highest);
}

TEST_CASE("tiles and shading are the same on any number of threads") {
    const Heightfield field = rough(300, 260, 9);
    const TerrainTiles one = TerrainTiles::over(field, 1), many = TerrainTiles::over(field, 5);
    REQUIRE(one.tiles.size() == many.tiles.size());
    for (size_t i = 0; i < one.tiles.size(); ++i) {
        CHECK(one.tiles[i].error == many.tiles[i].error);
        CHECK(one.tiles[i].lowest == many.tiles[i].lowest);
    }
    CHECK(illuminate(field, {}, 1) == illuminate(field, {}, 5));
}

TEST_CASE("illumination is Lambert's cosine") {
    Relief relief;
    relief.altitude = 45.0;
    relief.azimuth = 270.0;  // from the west
    const auto level = illuminate(shaped(3, 3, [](int32_t, int32_t) { return 7.0; }), relief, 1);
    CHECK(level == std::vector<uint8_t>(9, 180));  // sine of 45 degrees
    const auto facing = illuminate(shaped(3, 3, [](int32_t column, int32_t) { return column; }), relief, 1);
    CHECK(facing == std::vector<uint8_t>(9, 255));
    const auto away =
        illuminate(shaped(3, 3, [](int32_t column, int32_t) { return -2.0 * column; }), relief, 1);
    CHECK(away == std::vector<uint8_t>(9, 0));
    relief.azimuth = 0.0;  // from the north, where rows begin
    const auto north = illuminate(shaped(3, 3, [](int32_t, int32_t row) { return -2.0 * row; }), relief, 1);
    CHECK(north == std::vector<uint8_t>(9, 0));
    std::vector<float> heights(9, 4.0F);
    heights[4] = missing;
    CHECK(illuminate(Heightfield(heights, 3, 3, 0, 0, 1, 1), relief, 1)[0] == 180);
}

#include "decalgl/terrain/tiles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "decalgl/core/parallel.h"

namespace decalgl {
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();

struct Corner {
    int32_t column;
    int32_t row;
};

// The height at a sample of the triangle pair between two corner samples.
double coarse_height(const Heightfield& field, Corner from, Corner to, int32_t column, int32_t row) {
    const double u = to.column > from.column ? double(column - from.column) / (to.column - from.column) : 0.0;
    const double v = to.row > from.row ? double(row - from.row) / (to.row - from.row) : 0.0;
    const double north_west = static_cast<double>(field.height(from.row, from.column));
    const double south_east = static_cast<double>(field.height(to.row, to.column));
    if (v > u) {
        const double south_west = static_cast<double>(field.height(to.row, from.column));
        return north_west + v * (south_west - north_west) + u * (south_east - south_west);
    }
    const double north_east = static_cast<double>(field.height(from.row, to.column));
    return north_west + u * (north_east - north_west) + v * (south_east - north_east);
}

float level_error(const Heightfield& field, Corner first, Corner last, int32_t step) {
    double worst = 0.0;
    for (int32_t row = first.row; row < last.row; row += step) {
        for (int32_t column = first.column; column < last.column; column += step) {
            const Corner from{column, row};
            const Corner to{std::min(column + step, last.column), std::min(row + step, last.row)};
            for (int32_t r = from.row; r <= to.row; ++r)
                for (int32_t c = from.column; c <= to.column; ++c)
                    worst = std::max(worst, std::abs(coarse_height(field, from, to, c, r) -
                                                     static_cast<double>(field.height(r, c))));
        }
    }
    return static_cast<float>(worst);
}

TerrainTile measure_tile(const Heightfield& field, Corner first) {
    const Corner last{std::min(first.column + tile_quads, field.columns() - 1),
                      std::min(first.row + tile_quads, field.rows() - 1)};
    TerrainTile tile;
    tile.column = first.column;
    tile.row = first.row;
    tile.lowest = infinite;
    tile.highest = -infinite;
    bool has_hole = false;
    for (int32_t row = first.row; row <= last.row; ++row) {
        for (int32_t column = first.column; column <= last.column; ++column) {
            const float height = field.height(row, column);
            has_hole |= std::isnan(height);
            tile.lowest = std::fmin(tile.lowest, height);
            tile.highest = std::fmax(tile.highest, height);
        }
    }
    for (int level = 1; level < tile_levels; ++level)
        tile.error[static_cast<size_t>(level)] = has_hole
                                                     ? infinite
                                                     : std::max(tile.error[static_cast<size_t>(level - 1)],
                                                                level_error(field, first, last, 1 << level));
    return tile;
}

}  // namespace

TerrainTiles TerrainTiles::over(const Heightfield& heightfield, unsigned threads) {
    TerrainTiles result;
    result.columns = (heightfield.columns() - 1 + tile_quads - 1) / tile_quads;
    result.rows = (heightfield.rows() - 1 + tile_quads - 1) / tile_quads;
    std::vector<TerrainTile> tiles(static_cast<size_t>(result.columns) * static_cast<size_t>(result.rows));
    parallel_for(tiles.size(), 4, threads, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const auto column = static_cast<int32_t>(i) % result.columns;
            const auto row = static_cast<int32_t>(i) / result.columns;
            tiles[i] = measure_tile(heightfield, {column * tile_quads, row * tile_quads});
        }
    });
    result.tiles = std::move(tiles);
    const auto& heights = heightfield.heights();
    result.has_holes = std::any_of(heights.begin(), heights.end(), [](float h) { return std::isnan(h); });
    return result;
}

}  // namespace decalgl

#include "technique/loops/ground.h"

#include <cmath>
#include <limits>

#include "decalgl/core/parallel.h"

namespace decalgl::loops {
namespace {

constexpr int32_t block_quads = 8;

const GroundRange nothing = {std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(), 0.0F};

// The squared slope of a triangle with two sides along the axes.
float slope2(double along_x, double along_y, const Heightfield& terrain) {
    const double x = along_x / terrain.dx(), y = along_y / terrain.dy();
    const double value = x * x + y * y;
    return std::isfinite(value) ? static_cast<float>(value) : 0.0F;
}

GroundRange range_of_block(const Heightfield& terrain, int32_t block_row, int32_t block_column) {
    GroundRange range = nothing;
    const int32_t last_row = std::min((block_row + 1) * block_quads, terrain.rows() - 1);
    const int32_t last_column = std::min((block_column + 1) * block_quads, terrain.columns() - 1);
    for (int32_t row = block_row * block_quads; row <= last_row; ++row)
        for (int32_t column = block_column * block_quads; column <= last_column; ++column) {
            const float here = terrain.height(row, column);
            if (!std::isnan(here))
                range.add({here, here, 0.0F});
            if (row == last_row || column == last_column)
                continue;
            const double nw = double{here}, ne = double{terrain.height(row, column + 1)};
            const double sw = double{terrain.height(row + 1, column)}, se = double{terrain.height(row + 1, column + 1)};
            range.steepest = std::max({range.steepest, slope2(se - sw, sw - nw, terrain), slope2(ne - nw, se - ne, terrain)});
        }
    return range;
}

}  // namespace

Ground::Ground(const Heightfield& terrain, const Lattice& lattice, unsigned threads)
    : lattice_(lattice),
      x0_(terrain.x0()),
      y0_(terrain.y0()),
      dx_(block_quads * terrain.dx()),
      dy_(block_quads * terrain.dy()),
      all_(nothing) {
    const auto blocks = [](int32_t samples) { return std::max(1, (samples - 1 + block_quads - 1) / block_quads); };
    Level base{blocks(terrain.columns()), blocks(terrain.rows()), {}};
    base.blocks.resize(size_t(base.columns) * size_t(base.rows));
    parallel_for(base.blocks.size(), 64, threads, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i)
            base.blocks[i] = range_of_block(terrain, static_cast<int32_t>(i) / base.columns,
                                            static_cast<int32_t>(i) % base.columns);
    });
    for (const GroundRange& range : base.blocks)
        all_.add(range);
    if (all_.lowest > all_.highest)
        all_ = {0.0F, 0.0F, 0.0F};
    levels_.push_back(std::move(base));
    while (levels_.back().blocks.size() > 1) {
        const Level& below = levels_.back();
        Level level{(below.columns + 1) / 2, (below.rows + 1) / 2, {}};
        level.blocks.assign(size_t(level.columns) * size_t(level.rows), nothing);
        for (int32_t row = 0; row < below.rows; ++row)
            for (int32_t column = 0; column < below.columns; ++column)
                level.blocks[size_t(row / 2 * level.columns + column / 2)].add(
                    below.blocks[size_t(row * below.columns + column)]);
        levels_.push_back(std::move(level));
    }
}

GroundRange Ground::below(const LatticeBox& box) const {
    const Level& base = levels_[0];
    const auto column_of = [&](int32_t x) {
        const double place = std::floor((lattice_.left + lattice_.quantum * x - x0_) / dx_);
        return static_cast<int32_t>(std::clamp(place, 0.0, base.columns - 1.0));
    };
    const auto row_of = [&](int32_t y) {
        const double place = std::floor((y0_ - lattice_.bottom - lattice_.quantum * y) / dy_);
        return static_cast<int32_t>(std::clamp(place, 0.0, base.rows - 1.0));
    };
    int32_t left = column_of(box.min_x), right = column_of(box.max_x);
    int32_t top = row_of(box.max_y), bottom = row_of(box.min_y);
    size_t level = 0;
    for (; right - left > 1 || bottom - top > 1; ++level) {
        left /= 2;
        right /= 2;
        top /= 2;
        bottom /= 2;
    }
    GroundRange range = nothing;
    for (int32_t row = top; row <= bottom; ++row)
        for (int32_t column = left; column <= right; ++column)
            range.add(levels_[level].blocks[size_t(row * levels_[level].columns + column)]);
    // Holes have no ground: what is judged there is judged as if it were everywhere.
    return range.lowest <= range.highest ? range : all_;
}

}  // namespace decalgl::loops

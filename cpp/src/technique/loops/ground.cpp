#include "technique/loops/ground.h"

#include <cmath>
#include <limits>

namespace decalgl::loops {
namespace {

constexpr int32_t block_quads = 8;

const GroundRange nothing = {std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
                             0.0F};

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
            const double sw = double{terrain.height(row + 1, column)},
                         se = double{terrain.height(row + 1, column + 1)};
            range.steepest = std::max(
                {range.steepest, slope2(se - sw, sw - nw, terrain), slope2(ne - nw, se - ne, terrain)});
        }
    return range;
}

int32_t blocks_of(int32_t samples) {
    return std::max(1, (samples - 1 + block_quads - 1) / block_quads);
}

}  // namespace

Ground::Ground(const Heightfield& terrain, const Lattice& lattice, unsigned threads)
    : lattice_(lattice),
      x0_(terrain.x0()),
      y0_(terrain.y0()),
      dx_(block_quads * terrain.dx()),
      dy_(block_quads * terrain.dy()),
      blocks_(blocks_of(terrain.columns()), blocks_of(terrain.rows()), nothing, threads,
              [&](int32_t row, int32_t column) { return range_of_block(terrain, row, column); }),
      all_(blocks_.all()) {
    if (all_.lowest > all_.highest)
        all_ = {0.0F, 0.0F, 0.0F};
}

GroundRange Ground::below(const LatticeBox& box) const {
    const auto column_of = [&](int32_t x) {
        const double place = std::floor((lattice_.left + lattice_.quantum * x - x0_) / dx_);
        return static_cast<int32_t>(std::clamp(place, 0.0, blocks_.columns() - 1.0));
    };
    const auto row_of = [&](int32_t y) {
        const double place = std::floor((y0_ - lattice_.bottom - lattice_.quantum * y) / dy_);
        return static_cast<int32_t>(std::clamp(place, 0.0, blocks_.rows() - 1.0));
    };
    const GroundRange range =
        blocks_.over({column_of(box.min_x), column_of(box.max_x), row_of(box.max_y), row_of(box.min_y)}, 1);
    // Holes have no ground: what is judged there is judged as if it were everywhere.
    return range.lowest <= range.highest ? range : all_;
}

}  // namespace decalgl::loops

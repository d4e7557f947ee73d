#include "technique/static_decals/cell_grid.h"

#include <algorithm>

namespace decalgl {

CellGrid CellGrid::over(const Bounds& bounds, const PositionGrid& positions, int32_t resolution) {
    const double extent =
        std::max({bounds.max_x - bounds.min_x, bounds.max_y - bounds.min_y, positions.span / 1024.0});
    CellGrid grid;
    grid.positions = positions;
    grid.cell_size = std::exp2(std::ceil(std::log2(extent / resolution)));
    grid.quantum = grid.cell_size / CELL_QUANTA;
    const auto cell_of = [&](double value, double origin) {
        return static_cast<int64_t>(std::floor((value - origin) / grid.cell_size));
    };
    grid.first_cell_x = cell_of(bounds.min_x, positions.origin_x);
    grid.first_cell_y = cell_of(bounds.min_y, positions.origin_y);
    grid.columns = static_cast<int32_t>(cell_of(bounds.max_x, positions.origin_x) - grid.first_cell_x + 1);
    grid.rows = static_cast<int32_t>(cell_of(bounds.max_y, positions.origin_y) - grid.first_cell_y + 1);
    const int32_t bucket_side = 1 << BUCKET_BITS;
    grid.bucket_columns = (grid.columns + bucket_side - 1) / bucket_side;
    grid.bucket_rows = (grid.rows + bucket_side - 1) / bucket_side;
    return grid;
}

}  // namespace decalgl

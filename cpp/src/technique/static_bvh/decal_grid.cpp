#include "technique/static_bvh/decal_grid.h"

#include <cmath>

namespace decalgl::bvh {
namespace {

int32_t ceiling_of_share(int64_t length, int64_t cells) {
    return static_cast<int32_t>((length + cells - 1) / cells);
}

}  // namespace

DecalGrid DecalGrid::over(const LatticeBox& box, int32_t cells) {
    DecalGrid grid;
    grid.box = box;
    if (box.empty())
        return grid;
    const int64_t width = int64_t{box.max_x} - box.min_x + 1;
    const int64_t height = int64_t{box.max_y} - box.min_y + 1;
    grid.cell_width = ceiling_of_share(width, cells);
    grid.cell_height = ceiling_of_share(height, cells);
    grid.columns = ceiling_of_share(width, grid.cell_width);
    grid.rows = ceiling_of_share(height, grid.cell_height);
    return grid;
}

LatticeBox DecalGrid::cell_box(uint32_t cell) const {
    const auto column = static_cast<int32_t>(cell % static_cast<uint32_t>(columns));
    const auto row = static_cast<int32_t>(cell / static_cast<uint32_t>(columns));
    const int32_t left = box.min_x + column * cell_width;
    const int32_t bottom = box.min_y + row * cell_height;
    return common(box, {left, bottom, left + cell_width - 1, bottom + cell_height - 1});
}

CellRange DecalGrid::columns_of(const LatticeBox& inner) const {
    return {(inner.min_x - box.min_x) / cell_width, (inner.max_x - box.min_x) / cell_width};
}

CellRange DecalGrid::rows_of(const LatticeBox& inner) const {
    return {(inner.min_y - box.min_y) / cell_height, (inner.max_y - box.min_y) / cell_height};
}

CellRange DecalGrid::columns_in_row(const Quadrilateral& outline, int32_t row) const {
    const double bottom = double(box.min_y) + double(row) * cell_height - rounding;
    const double top = bottom + cell_height + 2.0 * rounding;
    double left = 1e300, right = -1e300;
    for (size_t i = 0; i < 4; ++i) {
        const size_t j = (i + 1) % 4;
        const double low = std::min(outline.y[i], outline.y[j]);
        const double high = std::max(outline.y[i], outline.y[j]);
        if (high < bottom || low > top)
            continue;
        for (const double y : {std::max(low, bottom), std::min(high, top)}) {
            const double rise = outline.y[j] - outline.y[i];
            const double t = rise == 0.0 ? 0.0 : (y - outline.y[i]) / rise;
            const double x = outline.x[i] + t * (outline.x[j] - outline.x[i]);
            left = std::min(left, x);
            right = std::max(right, x);
            // A level edge lies in the row with both its ends.
            if (rise == 0.0) {
                left = std::min(left, outline.x[j]);
                right = std::max(right, outline.x[j]);
            }
        }
    }
    const double first = std::floor((left - rounding - box.min_x) / cell_width);
    const double last = std::floor((right + rounding - box.min_x) / cell_width);
    return {static_cast<int32_t>(std::clamp(first, 0.0, double(columns))),
            static_cast<int32_t>(std::clamp(last, -1.0, double(columns - 1)))};
}

}  // namespace decalgl::bvh

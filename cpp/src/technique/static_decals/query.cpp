// What lies at a map position: the walk of static_decals.frag.glsl on the CPU, in double precision and to the
// end.
#include <cmath>

#include "technique/static_decals/prepared_decals.h"

namespace decalgl {
namespace {

struct Piece {
    double x0, y0, x1, y1;

    explicit Piece(CellTexel texel)
        : x0(static_cast<double>(texel.x & 0xFFFFu)),
          y0(static_cast<double>(texel.x >> 16)),
          x1(static_cast<double>(texel.y & 0xFFFFu)),
          y1(static_cast<double>(texel.y >> 16)) {}

    bool crosses_walk(double x, double y) const {
        const bool starts_left = x0 == COORDINATE_BIAS;
        const bool ends_left = x1 == COORDINATE_BIAS;
        const bool on_border = starts_left != ends_left && (starts_left ? y0 : y1) <= y;
        const bool on_row = y0 <= y && y < y1 && (x - x0) * (y1 - y0) >= (y - y0) * (x1 - x0);
        return on_border != on_row;
    }

    bool within(double x, double y, double radius) const {
        const double dx = x1 - x0;
        const double dy = y1 - y0;
        const double length2 = dx * dx + dy * dy;
        double t = length2 > 0.0 ? ((x - x0) * dx + (y - y0) * dy) / length2 : 0.0;
        t = t < 0.0 ? 0.0 : t > 1.0 ? 1.0 : t;
        return std::hypot(x - x0 - t * dx, y - y0 - t * dy) <= radius;
    }
};

}  // namespace

std::vector<FeatureReference> PreparedDecals::query(double x, double y) const {
    std::vector<FeatureReference> found;
    const double cell_x = (x - grid.left()) / grid.cell_size;
    const double cell_y = (y - grid.bottom()) / grid.cell_size;
    if (!(cell_x >= 0.0 && cell_x < grid.columns && cell_y >= 0.0 && cell_y < grid.rows))
        return found;
    const auto column = static_cast<int32_t>(cell_x);
    const auto row = static_cast<int32_t>(cell_y);
    const double local_x = (cell_x - column) * CELL_QUANTA;
    const double local_y = (cell_y - row) * CELL_QUANTA;

    const uint32_t cell = grid.cell_index(column, row);
    for (uint32_t at = cell_starts[cell]; at < cell_starts[cell + 1];) {
        const CellTexel header = texels[at++];
        const int scale = static_cast<int>(header.x >> GROUP_SCALE_SHIFT & GROUP_SCALE_MASK);
        const double px = std::ldexp(local_x, -scale) + COORDINATE_BIAS;
        const double py = std::ldexp(local_y, -scale) + COORDINATE_BIAS;
        const double radius = std::ldexp(static_cast<double>(styles[header.y].half_width), -scale);
        bool covered = (header.x & GROUP_COVERS) != 0;
        for (; at < cell_starts[cell + 1] && !is_header(texels[at]); ++at) {
            const Piece piece(texels[at]);
            if (header.x & GROUP_LINE)
                covered |= piece.within(px, py, radius);
            else
                covered ^= piece.crosses_walk(px, py);
        }
        if (covered)
            found.push_back(slots[header.y]);
    }
    return found;
}

}  // namespace decalgl

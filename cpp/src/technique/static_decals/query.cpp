// What lies at a map position: the walk of point.glsl on the CPU, in double precision and to the end.
#include <cmath>

#include "technique/static_decals/prepared_decals.h"

namespace decalgl {
namespace {

struct Point {
    double x, y;
};

Point point_of(uint32_t word) {
    return {static_cast<double>(word & COORDINATE_MASK),
            static_cast<double>(word >> COORDINATE_BITS & COORDINATE_MASK)};
}

bool crosses_walk(Point from, Point to, Point at, double left) {
    const bool starts_left = from.x == left, ends_left = to.x == left;
    const bool on_border = starts_left != ends_left && (starts_left ? from.y : to.y) <= at.y;
    const Point low = from.y <= to.y ? from : to, high = from.y <= to.y ? to : from;
    const bool on_row = low.y <= at.y && at.y < high.y &&
                        (at.x - low.x) * (high.y - low.y) >= (at.y - low.y) * (high.x - low.x);
    return on_border != on_row;
}

bool within_stroke(Point from, Point to, Point at, double radius) {
    const double dx = to.x - from.x, dy = to.y - from.y;
    const double length2 = dx * dx + dy * dy;
    double t = length2 > 0.0 ? ((at.x - from.x) * dx + (at.y - from.y) * dy) / length2 : 0.0;
    t = t < 0.0 ? 0.0 : t > 1.0 ? 1.0 : t;
    return std::hypot(at.x - from.x - t * dx, at.y - from.y - t * dy) <= radius;
}

// Where a position is: its cell, and the quanta from the cell's corner.
struct CellPlace {
    int level;
    uint32_t entry;
    double local_x, local_y;
};

bool locate(const PreparedDecals& decals, double x, double y, CellPlace& place) {
    const BucketGrid& grid = decals.grid;
    const double bucket_x = (x - grid.left()) / grid.bucket_size;
    const double bucket_y = (y - grid.bottom()) / grid.bucket_size;
    if (!(bucket_x >= 0.0 && bucket_x < grid.columns && bucket_y >= 0.0 && bucket_y < grid.rows))
        return false;
    const auto column = static_cast<int64_t>(bucket_x), row = static_cast<int64_t>(bucket_y);
    const uint32_t bucket = decals.bucket_entries[grid.bucket_index(column, row)];
    place.level = static_cast<int>(bucket & ((1U << LEVEL_BITS) - 1));
    const double side = std::ldexp(1.0, place.level);
    const double cell_x = (bucket_x - static_cast<double>(column)) * side;
    const double cell_y = (bucket_y - static_cast<double>(row)) * side;
    const auto cell = static_cast<uint32_t>(cell_y) << place.level | static_cast<uint32_t>(cell_x);
    place.entry = decals.cells[(bucket >> LEVEL_BITS) + cell];
    place.local_x = (cell_x - std::floor(cell_x)) * cell_quanta(place.level);
    place.local_y = (cell_y - std::floor(cell_y)) * cell_quanta(place.level);
    return true;
}

}  // namespace

Span<const uint32_t> PreparedDecals::list(uint32_t cell_entry) const {
    const size_t first = size_t{4} * (cell_entry >> COUNT_BITS);
    const uint32_t texels = cell_entry & COUNT_ESCAPE;
    return {words.data() + first, texels < COUNT_ESCAPE ? size_t{4} * texels : words.size() - first};
}

std::vector<FeatureReference> PreparedDecals::query(double x, double y) const {
    std::vector<FeatureReference> found;
    CellPlace place{};
    if (!locate(*this, x, y, place))
        return found;
    const double left = cell_bias(place.level);
    bool covered = false, is_line = false;
    uint32_t slot = 0;
    double radius = 0.0;
    Point at{}, previous{};
    const auto end_group = [&] {
        if (covered && styles[slot].color[3] != 0)
            found.push_back(slots[slot].feature);
        covered = false;
    };
    for (const uint32_t word : list(place.entry)) {
        if ((word & HEADER) != 0) {
            end_group();
            if (word == LIST_END)
                break;
            slot = word & SLOT_MASK;
            is_line = (word & LINE) != 0;
            covered = (word & COVERS) != 0;
            const int scale = is_line ? scale_of(slot) : 0;
            radius = std::ldexp(static_cast<double>(styles[slot].half_width), -scale);
            at = {std::ldexp(place.local_x, -scale) + left, std::ldexp(place.local_y, -scale) + left};
            continue;
        }
        const Point point = point_of(word);
        const Point from = (word & MOVE) != 0 ? point : previous;
        previous = point;
        if (is_line)
            covered = covered || within_stroke(from, point, at, radius);
        else if ((word & MOVE) == 0)
            covered = covered != crosses_walk(from, point, at, left);
    }
    end_group();
    return found;
}

}  // namespace decalgl

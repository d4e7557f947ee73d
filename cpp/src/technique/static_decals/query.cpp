// What lies at a map position.
#include <cmath>

#include "technique/static_decals/list_reader.h"

namespace decalgl {
namespace {

// The cell of a position, and its list; false outside the grid.
bool locate(const PreparedDecals& decals, double x, double y, CellPoints<double>& cell, uint32_t& entry) {
    const BucketGrid& grid = decals.grid;
    const double bucket_x = (x - grid.left()) / grid.bucket_size;
    const double bucket_y = (y - grid.bottom()) / grid.bucket_size;
    if (!(bucket_x >= 0.0 && bucket_x < grid.columns && bucket_y >= 0.0 && bucket_y < grid.rows))
        return false;
    cell.bucket_column = static_cast<int64_t>(bucket_x);
    cell.bucket_row = static_cast<int64_t>(bucket_y);
    const uint32_t bucket = decals.bucket_entries[grid.bucket_index(cell.bucket_column, cell.bucket_row)];
    cell.level = static_cast<int>(bucket & ((1U << LEVEL_BITS) - 1));
    const double side = std::ldexp(1.0, cell.level), quanta = cell_quanta(cell.level);
    const double cell_x = (bucket_x - static_cast<double>(cell.bucket_column)) * side;
    const double cell_y = (bucket_y - static_cast<double>(cell.bucket_row)) * side;
    const double column = std::floor(cell_x), row = std::floor(cell_y);
    const auto index = static_cast<uint32_t>(row) << cell.level | static_cast<uint32_t>(column);
    entry = decals.cells[(bucket >> LEVEL_BITS) + index];
    cell.corner = {column * quanta, row * quanta};
    cell.x = {(cell_x - column) * quanta};
    cell.y = {(cell_y - row) * quanta};
    return true;
}

}  // namespace

Span<const uint32_t> PreparedDecals::list(uint32_t cell_entry) const {
    const size_t first = size_t{4} * (cell_entry >> COUNT_BITS);
    const uint32_t texels = cell_entry & COUNT_ESCAPE;
    return {words.data() + first, texels < COUNT_ESCAPE ? size_t{4} * texels : words.size() - first};
}

std::vector<FeatureReference> PreparedDecals::query(const SeenPoint& point) const {
    std::vector<FeatureReference> found;
    CellPoints<double> cell;
    uint32_t entry = 0;
    if (!locate(*this, point.x, point.y, cell, entry))
        return found;
    const Slope slope({point.gradient_x, point.gradient_y}, point.forward_z);
    ListReader<double>(*this, cell, slope)
        .read(list(entry), [&](uint32_t slot, const StyleReader&, const auto& shares, PointRange) {
            const FeatureReference feature = slots[slot].feature;
            if (shares[0] <= 1.0 && styles[slot].color[3] != 0 &&
                std::find(found.begin(), found.end(), feature) == found.end())
                found.push_back(feature);
        });
    return found;
}

}  // namespace decalgl

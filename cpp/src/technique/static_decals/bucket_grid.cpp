#include "technique/static_decals/bucket_grid.h"

#include <algorithm>

namespace decalgl {

BucketGrid BucketGrid::over(const Bounds& bounds, const PositionGrid& positions, int32_t resolution) {
    const double extent =
        std::max({bounds.max_x - bounds.min_x, bounds.max_y - bounds.min_y, positions.span / 1024.0});
    BucketGrid grid;
    grid.positions = positions;
    grid.bucket_size = std::exp2(std::ceil(std::log2(extent / resolution)));
    grid.quantum = grid.bucket_size / BUCKET_QUANTA;
    const auto bucket_of = [&](double value, double origin) {
        return static_cast<int64_t>(std::floor((value - origin) / grid.bucket_size));
    };
    grid.first_bucket_x = bucket_of(bounds.min_x, positions.origin_x);
    grid.first_bucket_y = bucket_of(bounds.min_y, positions.origin_y);
    const int64_t last_x = bucket_of(bounds.max_x, positions.origin_x);
    const int64_t last_y = bucket_of(bounds.max_y, positions.origin_y);
    grid.columns = static_cast<int32_t>(last_x - grid.first_bucket_x + 1);
    grid.rows = static_cast<int32_t>(last_y - grid.first_bucket_y + 1);
    return grid;
}

}  // namespace decalgl

#include "decalgl/terrain/heightfield.h"

#include <cmath>
#include <string>
#include <utility>

#include "decalgl/core/error.h"

namespace decalgl {

Heightfield::Heightfield(std::vector<float> heights, int32_t rows, int32_t columns, double x0, double y0,
                         double dx, double dy)
    : rows_(rows), columns_(columns), x0_(x0), y0_(y0), dx_(dx), dy_(dy) {
    if (rows < 1 || columns < 1 || heights.size() != static_cast<size_t>(rows) * static_cast<size_t>(columns))
        throw Error(ErrorKind::input, "terrain: " + std::to_string(heights.size()) + " heights do not make " +
                                          std::to_string(rows) + " rows of " + std::to_string(columns) +
                                          " columns");
    if (!std::isfinite(x0) || !std::isfinite(y0) || !(dx > 0.0) || !(dy > 0.0) || !std::isfinite(dx * dy))
        throw Error(ErrorKind::input,
                    "terrain: the position must be finite and the sample distances positive");
    for (size_t i = 0; i < heights.size(); ++i) {
        if (std::isinf(heights[i]))
            throw Error(ErrorKind::input, "terrain: the height of sample " + std::to_string(i) +
                                              " is infinite; mark missing samples with NaN");
        lowest_ = std::fmin(lowest_, heights[i]);
        highest_ = std::fmax(highest_, heights[i]);
    }
    heights_ = std::make_shared<const std::vector<float>>(std::move(heights));
}

Heightfield Heightfield::flat(const Bounds& bounds, float height) {
    if (!(bounds.max_x > bounds.min_x) || !(bounds.max_y > bounds.min_y))
        throw Error(ErrorKind::input,
                    "terrain: bounds must be (min x, min y, max x, max y) with min below max");
    return Heightfield({height, height, height, height}, 2, 2, bounds.min_x, bounds.max_y,
                       bounds.max_x - bounds.min_x, bounds.max_y - bounds.min_y);
}

Heightfield Heightfield::exaggerated(double factor) const {
    if (!std::isfinite(factor) || factor < 0.0)
        throw Error(ErrorKind::input, "exaggeration must be a finite factor, zero or more");
    std::vector<float> scaled(heights());
    for (float& height : scaled)
        height = static_cast<float>(static_cast<double>(height) * factor);
    return Heightfield(std::move(scaled), rows_, columns_, x0_, y0_, dx_, dy_);
}

Bounds Heightfield::bounds() const {
    return {x0_, y0_ - (rows_ - 1) * dy_, x0_ + (columns_ - 1) * dx_, y0_};
}

}  // namespace decalgl

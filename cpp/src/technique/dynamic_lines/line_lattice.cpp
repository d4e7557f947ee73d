#include "technique/dynamic_lines/line_lattice.h"

#include <algorithm>
#include <cmath>

namespace decalgl {

LineLattice LineLattice::over(const Bounds& bounds) {
    const double extent = std::max({bounds.max_x - bounds.min_x, bounds.max_y - bounds.min_y, 1e-6});
    LineLattice lattice;
    lattice.quantum = std::exp2(std::ceil(std::log2(extent * 1.001 / lattice_reach)));
    const auto nearest = [&](double low, double high) {
        return std::round(0.5 * (low + high) / lattice.quantum) * lattice.quantum;
    };
    lattice.origin_x = nearest(bounds.min_x, bounds.max_x);
    lattice.origin_y = nearest(bounds.min_y, bounds.max_y);
    return lattice;
}

ivec2 LineLattice::place(double x, double y) const {
    return {static_cast<int32_t>(std::lrint((x - origin_x) / quantum)),
            static_cast<int32_t>(std::lrint((y - origin_y) / quantum))};
}

Bounds LineLattice::box() const {
    const double reach = (lattice_reach - 1) * quantum;
    return {origin_x - reach, origin_y - reach, origin_x + reach, origin_y + reach};
}

}  // namespace decalgl

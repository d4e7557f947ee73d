// What lies at a map position, with all details: of each arc only what is near it is looked at.
#include <cmath>
#include <unordered_set>

#include "technique/loops/half_float.h"
#include "technique/loops/prepared_loops.h"

namespace decalgl::loops {
namespace {

// Whether an edge crosses the point's row at or left of it.
bool crosses(LatticePoint a, LatticePoint b, LatticePoint point) {
    if ((a.y <= point.y) == (b.y <= point.y))
        return false;
    if (a.y > b.y)
        std::swap(a, b);
    return doubled_area(a, b, point) <= 0;
}

class Query {
public:
    Query(const LoopsIndex& index, const Slots& slots, LatticePoint point)
        : index_(index), slots_(slots), point_(point) {
        // What is left out of an arc lies in a region that does not hold the point, and its base does too.
        active_ = active_arcs(index.arcs, index.steps, 0, [&](uint32_t p, size_t arc) {
            const Activation& activation = index.activations[p];
            const double radius =
                half_to_double(static_cast<uint16_t>(activation.error_and_radius >> 16)) / length_scale;
            const double reach = double{slots.reaches[arc]} / index.lattice.quantum;
            return distance_between(point, {activation.x, activation.y}) <= radius + reach + 1.0;
        });
    }

    bool is_in(size_t slot) const {
        const Style& style = slots_.styles[slot];
        const size_t feature = slots_.features[slot];
        bool inside = false;
        for (const uint32_t arc :
             style.is_fill() ? index_.arcs.fill_of(feature) : index_.arcs.stroke_of(feature)) {
            if (index_.arcs.kinds[arc] == ArcKind::frame)
                continue;
            const Span<const LatticePoint> points = active_.of(arc);
            for (size_t i = 0; i + 1 < points.size(); ++i)
                if (!style.is_fill())
                    inside = inside || distance_to_segment(point_, points[i], points[i + 1]) <=
                                           double{style.half_width};
                else if (crosses(points[i], points[i + 1], point_))
                    inside = !inside;
        }
        return inside;
    }

private:
    const LoopsIndex& index_;
    const Slots& slots_;
    LatticePoint point_;
    ActiveArcs active_;
};

}  // namespace

std::vector<FeatureReference> PreparedLoops::query(const SeenPoint& point) const {
    std::vector<FeatureReference> found;
    const Lattice& lattice = index_->lattice;
    if (!(std::abs((point.x - lattice.left) / lattice.quantum) <= 2.0 * lattice_extent &&
          std::abs((point.y - lattice.bottom) / lattice.quantum) <= 2.0 * lattice_extent))
        return found;
    const LatticePoint place = lattice.nearest(point.x, point.y);
    if (!lattice.terrain.holds(place))
        return found;
    const Query query(*index_, *slots_, place);
    std::unordered_set<uint64_t> seen;
    for (size_t rank = slots_->upwards.size(); rank-- > 0;) {
        const size_t slot = slots_->upwards[rank];
        const FeatureReference feature = slots_->decals[slot].feature;
        if (slots_->styles[slot].is_shown() && query.is_in(slot) &&
            seen.insert(uint64_t{feature.layer} << 32 | feature.feature).second)
            found.push_back(feature);
    }
    return found;
}

}  // namespace decalgl::loops

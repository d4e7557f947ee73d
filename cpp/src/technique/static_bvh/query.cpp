// What lies at a map position: the walks of static_bvh.frag.glsl on the CPU and to their end.
#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "technique/static_bvh/complete_tree.h"
#include "technique/static_bvh/prepared_bvh.h"
#include "technique/static_bvh/quad_walk.h"
#include "technique/static_bvh/stroke_cover.h"

namespace decalgl::bvh {
namespace {

bool stroke_holds(const DecalGroup& group, Object object, LatticePoint point) {
    if (!stroke_covers(group, object.segment(), point))
        return false;
    if (group.cut == OutlineMode::normal)
        return true;
    const bool inside =
        object.exterior != NO_EXTERIOR && holds(group, group.exteriors[object.exterior], point);
    return inside == (group.cut == OutlineMode::inset);
}

bool fill_holds(const DecalGroup& group, const Exterior& exterior, LatticePoint point) {
    return holds(group, exterior, point) && hatch_holds(group, group.styles[exterior.slot].look, point);
}

std::vector<uint32_t> slots_at(const DecalGroup& group, LatticePoint point) {
    std::vector<uint32_t> found;
    if (!group.grid.box.holds(point))
        return found;
    const uint32_t cell = group.grid.cell_at(point);
    const CellStart start = group.cells[cell];
    const auto reached = [&](const LatticeBox& box) { return box.holds(point); };
    traverse(group.nodes.data() + start.node, group.objects_in(cell), reached, [&](uint32_t object) {
        const Object own = group.object(start.object + object);
        if (own.is_stroke() ? stroke_holds(group, own, point)
                            : fill_holds(group, group.exteriors[own.place], point))
            found.push_back(group.slot_of(own));
        return true;
    });
    // Strokes come segment by segment, along a curve even out of order.
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

}  // namespace

std::vector<FeatureReference> PreparedBvh::query(double x, double y) const {
    std::vector<FeatureReference> found;
    const double lattice_x = lattice.x_of(x), lattice_y = lattice.y_of(y);
    if (!(std::abs(lattice_x) <= lattice_extent && std::abs(lattice_y) <= lattice_extent))
        return found;
    const LatticePoint point = lattice.nearest(x, y);
    std::unordered_set<uint64_t> seen;
    for (size_t group = groups.size(); group-- > 0;)
        for (const uint32_t slot : slots_at(groups[group], point)) {
            // A feature may show more than one of its decals.
            const FeatureReference feature = slots[groups[group].first_slot + slot];
            if (seen.insert(uint64_t{feature.layer} << 32 | feature.feature).second)
                found.push_back(feature);
        }
    return found;
}

}  // namespace decalgl::bvh

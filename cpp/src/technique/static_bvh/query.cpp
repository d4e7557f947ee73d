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

// Where an object covers a point: a slot, and the place across its stroke.
struct Cover {
    uint32_t rank;
    uint32_t slot;
    double share;
};

bool on_its_side(const DecalGroup& group, Object object, LatticePoint point) {
    if (group.cut == OutlineMode::normal)
        return true;
    const bool inside =
        object.exterior != NO_EXTERIOR && holds(group, group.exteriors[object.exterior], point);
    return inside == (group.cut == OutlineMode::inset);
}

bool fill_holds(const DecalGroup& group, const Exterior& exterior, LatticePoint point) {
    return holds(group, exterior, point) && hatch_holds(group, group.styles[exterior.slot].look, point);
}

std::vector<Cover> covers_of(const DecalGroup& group, LatticePoint point, const Slope& slope) {
    std::vector<Cover> covers;
    const CellStart start = group.cells[group.grid.cell_at(point)];
    const auto reached = [&](const LatticeBox& box) { return box.holds(point); };
    traverse(group.nodes.data() + start.node, start.count, reached, [&](uint32_t index) {
        const Object object = group.object(start.object + index);
        if (!object.is_stroke()) {
            const Exterior& exterior = group.exteriors[object.place];
            const Style& style = group.styles[exterior.slot];
            if (style.shows() && fill_holds(group, exterior, point))
                covers.push_back({style.rank, exterior.slot, 0.0});
            return true;
        }
        const double share = stroke_share(group, object.segment(), point, slope);
        if (share <= 1.0 && on_its_side(group, object, point))
            covers.push_back({group.styles[group.slot_of(object)].rank, group.slot_of(object), share});
        return true;
    });
    return covers;
}

std::vector<uint32_t> slots_at(const DecalGroup& group, LatticePoint point, const Slope& slope) {
    std::vector<uint32_t> found;
    if (!group.grid.box.holds(point))
        return found;
    std::vector<Cover> covers = covers_of(group, point, slope);
    // Strokes come segment by segment, along a curve even out of order.
    std::sort(covers.begin(), covers.end(),
              [](Cover a, Cover b) { return a.rank != b.rank ? a.rank < b.rank : a.share < b.share; });
    uint32_t last = NO_SLOT;
    for (const Cover& cover : covers) {
        if (cover.slot != last && band_shows(group, cover.slot, cover.share))
            found.push_back(cover.slot);
        last = cover.slot;
    }
    return found;
}

}  // namespace

std::vector<FeatureReference> PreparedBvh::query(const SeenPoint& point) const {
    std::vector<FeatureReference> found;
    const double lattice_x = lattice.x_of(point.x), lattice_y = lattice.y_of(point.y);
    if (!(std::abs(lattice_x) <= lattice_extent && std::abs(lattice_y) <= lattice_extent))
        return found;
    const LatticePoint nearest = lattice.nearest(point.x, point.y);
    const Slope slope({point.gradient_x, point.gradient_y}, point.forward_z);
    std::unordered_set<uint64_t> seen;
    for (size_t group = groups.size(); group-- > 0;)
        for (const uint32_t slot : slots_at(groups[group], nearest, slope)) {
            // A feature may show more than one of its decals.
            const FeatureReference feature = groups[group].slots[slot].feature;
            if (seen.insert(uint64_t{feature.layer} << 32 | feature.feature).second)
                found.push_back(feature);
        }
    return found;
}

}  // namespace decalgl::bvh

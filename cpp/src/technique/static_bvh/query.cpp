// What lies at a map position: the walks of static_bvh.frag.glsl on the CPU and to their end.
#include <algorithm>
#include <cmath>

#include "technique/static_bvh/complete_tree.h"
#include "technique/static_bvh/prepared_bvh.h"
#include "technique/static_bvh/quad_walk.h"

namespace decalgl::bvh {
namespace {

bool within_stroke(LatticePoint point, LatticePoint a, LatticePoint b, double half_width) {
    const double dx = double(b.x) - a.x, dy = double(b.y) - a.y;
    const double px = double(point.x) - a.x, py = double(point.y) - a.y;
    const double length2 = dx * dx + dy * dy;
    const double t = length2 > 0.0 ? std::clamp((px * dx + py * dy) / length2, 0.0, 1.0) : 0.0;
    return std::hypot(px - t * dx, py - t * dy) <= half_width;
}

bool holds(const DecalGroup& group, const Exterior& exterior, LatticePoint point) {
    bool inside = exterior.subtree != NO_SUBTREE && holds(group, exterior.subtree, point);
    for (uint32_t i = 0; i < exterior.interior_count; ++i)
        inside ^= holds(group, group.interiors[exterior.first_interior + i], point);
    return inside;
}

std::vector<uint32_t> slots_at(const DecalGroup& group, LatticePoint point) {
    std::vector<uint32_t> found;
    if (!group.grid.box.holds(point))
        return found;
    const uint32_t cell = group.grid.cell_at(point);
    const CellStart start = group.cells[cell];
    const auto reached = [&](const LatticeBox& box) { return box.holds(point); };
    traverse(group.nodes.data() + start.node, group.objects_in(cell), reached, [&](uint32_t object) {
        if (group.kind == FeatureKind::polygons) {
            const Exterior& exterior = group.exteriors[start.object + object];
            if (holds(group, exterior, point))
                found.push_back(exterior.slot);
        } else {
            const Segment segment = group.segments[start.object + object];
            const uint32_t slot = group.owners[segment.a];
            if (within_stroke(point, group.vertices[segment.a], group.vertices[segment.b],
                              double{group.styles[slot].half_width}))
                found.push_back(slot);
        }
        return true;
    });
    // Lines come segment by segment, along a curve even out of order.
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
    for (size_t group = groups.size(); group-- > 0;)
        for (const uint32_t slot : slots_at(groups[group], point))
            found.push_back(slots[groups[group].first_slot + slot]);
    return found;
}

}  // namespace decalgl::bvh

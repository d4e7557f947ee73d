// Looks: what slots of a group share beyond a colour and a width, in texels (bvh_layout.h).
#pragma once

#include <map>
#include <tuple>

#include "technique/static_bvh/prepared_bvh.h"

namespace decalgl::bvh {

class LookWriter {
public:
    LookWriter(const Lattice& lattice, GroupBuild& group) : lattice_(lattice), group_(group) {}

    // Where the look of a decal begins; adds to what the group needs.
    uint32_t place_of(const DecalView& decal);

private:
    uint32_t write(const StrokeStyle& style);
    uint32_t write(const Hatch& hatch);
    void write_set(const Hatch& hatch, double angle);

    const Lattice& lattice_;
    GroupBuild& group_;
    // By layer, role and place in the layer.
    std::map<std::tuple<const Layer*, DecalRole, size_t>, uint32_t> places_;
};

// A stroke's look, read back.
struct StrokeLook {
    Corner corner;
    Cap cap;
    SlopeCorrection slope;
    float limit;   // the cosine of the miter limit
    float period;  // quanta; 0: no pattern
    const LookTexel* marks;
    uint32_t mark_count;
    const LookTexel* bands;
    uint32_t band_count;
};
StrokeLook stroke_look(const DecalGroup& group, uint32_t place);

// Whether the lines of a fill's hatch, if it has one, take in a point.
bool hatch_holds(const DecalGroup& group, uint32_t place, LatticePoint point);

}  // namespace decalgl::bvh

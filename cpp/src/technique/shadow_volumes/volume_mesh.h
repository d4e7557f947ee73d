// One closed mesh: triangles of the map, stretched from below the ground to above it.
//
//            lid                 Walls stand where a triangle's edge has no other triangle on its other side.
//          _______               So the mesh is closed whatever the triangles are, and a place of the map lies in
//         /______/|   high       it as often as triangles cover it.
//         |      | |
//     ~~~~|~~~~~~|~|~~~ ground
//         |______|/   low
#pragma once

#include <unordered_map>
#include <vector>

#include "decalgl/core/span.h"
#include "technique/shadow_volumes/overlap_cells.h"
#include "technique/shadow_volumes/prepared_volumes.h"

namespace decalgl::volume {

struct MeshedVolumes {
    std::vector<Volume> volumes;  // corners and vertices counted from 0
    std::vector<VolumeVertex> vertices;
    std::vector<uint32_t> corners;
};

class VolumeMesher {
public:
    VolumeMesher(const HeightRanges& heights, MeshedVolumes& result) : heights_(heights), result_(result) {}

    // A convex piece, in quanta. What lies off the lattice is cut away; what has no ground under it is left out.
    void add(Span<const Vector2> corners);
    void add(const Triangle& triangle);
    // Ends the mesh of what was added.
    void finish(uint32_t decal);

private:
    uint32_t vertex(LatticePoint at, HeightRange heights);
    void add_walls();

    const HeightRanges& heights_;
    MeshedVolumes& result_;
    std::vector<uint32_t> triangles_;  // places of vertices, three each
    std::unordered_map<uint64_t, uint32_t> places_;
};

}  // namespace decalgl::volume

// One closed mesh: triangles of the map, stretched from below the ground to above it.
//
//            lid                 Walls stand where a triangle's edge has no other triangle on its other side.
//          _______               So the mesh is closed whatever the triangles are, and a place of the map lies in
//         /______/|   high       it as often as triangles cover it.
//         |      | |
//     ~~~~|~~~~~~|~|~~~ ground
//         |______|/   low
#pragma once

#include <vector>

#include "decalgl/core/span.h"
#include "technique/shadow_volumes/overlap_cells.h"
#include "technique/shadow_volumes/prepared_volumes.h"

namespace decalgl::volume {

struct MeshedVolumes {
    std::vector<Volume> volumes;  // each counts its corners from its own first vertex
    std::vector<VolumeVertex> vertices;
    std::vector<uint16_t> corners;
};

class VolumeMesher {
public:
    VolumeMesher(const Lattice& lattice, const HeightRanges& heights, MeshedVolumes& result)
        : lattice_(lattice), heights_(heights), result_(result) {}

    // A convex piece, in quanta. What lies off the lattice is cut away; what has no ground under it is left out.
    void add(Span<const Vector2> corners);
    void add(const Triangle& triangle);
    // Ends the mesh of what was added, or its meshes: one has at most most_vertices.
    void finish(uint32_t decal);

private:
    void mesh(uint32_t decal, size_t begin, size_t end);
    size_t know_points(size_t begin, size_t end);
    void add_vertices(size_t begin, size_t end);
    void add_walls();
    void add_corner(uint32_t corner) { result_.corners.push_back(static_cast<uint16_t>(corner)); }

    const Lattice& lattice_;
    const HeightRanges& heights_;
    MeshedVolumes& result_;
    std::vector<uint64_t> points_;     // three a triangle: x and y in one number
    std::vector<HeightRange> ranges_;  // one a triangle
    std::vector<uint64_t> known_;      // the points, each once
    std::vector<HeightRange> known_ranges_;
    std::vector<uint32_t> triangles_;  // places of vertices, three each
};

}  // namespace decalgl::volume

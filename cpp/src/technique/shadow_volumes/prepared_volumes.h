// Prepared shadow volumes: closed meshes around the terrain, in the order in which they are drawn.
//
//     vertices    a place on the map, and the heights between which the mesh stands there: two corners
//     corners     three a triangle: 2 * vertex, + 1 for the upper one. Of each volume the lids first, then the
//                 bottoms, then the walls
//
//     decals      bottom to top, each of one or more volumes
//     groups      bottom to top: decals of one colour, drawn as one mask
//     batches     of a group: no more volumes over any place than the stencil can count
//     volumes     of a batch: near each other on the map are near each other here
#pragma once

#include <array>
#include <vector>

#include "decalgl/core/large_array.h"
#include "decalgl/technique/technique.h"
#include "technique/shadow_volumes/height_ranges.h"
#include "technique/shadow_volumes/lattice.h"

namespace decalgl::volume {

struct VolumeVertex {
    int32_t x;
    int32_t y;
    float low;
    float high;
};
static_assert(sizeof(VolumeVertex) == 16, "a texel of RGBA32I");

struct Volume {
    uint32_t decal;
    uint32_t first_corner;
    uint32_t corner_count;
    uint32_t lid_corners;
    LatticeBox box;
    HeightRange heights;
};

struct Batch {
    uint32_t group;
    uint32_t first_volume;
    uint32_t volume_count;
};

struct Group {
    std::array<uint8_t, 4> color;  // straight alpha
};

class PreparedVolumes : public Prepared {
public:
    PreparedCounts counts() const override;
    FeatureReference feature(uint32_t id) const override { return decals[id].feature; }
    std::vector<FeatureReference> query(const SeenPoint& point) const override;
    bool shows_anything() const override { return !volumes.empty(); }
    // Throw Error(unsupported): volumes stay as they were prepared.
    void save(ArchiveWriter& archive, const std::string& prefix) const override;
    LayerLook look_of(uint32_t layer, size_t features) const override;
    std::shared_ptr<const Prepared> restyled(Span<const LayerLook> looks,
                                             const MemoryAccount& memory) const override;
    std::shared_ptr<const Prepared> edited(const LayerEdit& edit, const MemoryAccount& memory) const override;

    Lattice lattice;
    std::vector<Decal> decals;
    std::vector<uint32_t> volumes_of;  // each decal's volumes, one after the other
    std::vector<uint32_t> first_volume_of;
    std::vector<Group> groups;
    std::vector<Batch> batches;
    std::vector<Volume> volumes;
    LargeArray<VolumeVertex> vertices;
    LargeArray<uint32_t> corners;
    uint64_t features = 0;
    uint64_t segments = 0;
    double widest = 0.0;  // half width of a stroke, metres
    MemoryCharge charge;
};

// Throws Error(unsupported) for styles that volumes cannot show and for polygons without triangles, Error(memory),
// Error(cancelled).
std::unique_ptr<const PreparedVolumes> build_volumes(const TechniqueInput& input, Progress& progress);

}  // namespace decalgl::volume

// Prepared shadow volumes: closed meshes around the terrain, and the order in which they are drawn.
//
//     meshes      shared with what they are restyled to
//       decals    as they came, each of one or more volumes, one after the other
//       vertices  a place on the map, and the heights between which the mesh stands there: two corners
//       corners   three a triangle: 2 * vertex, + 1 for the upper one, counted from the volume's first vertex. Of each
//                 volume the lids first, then the bottoms, then the walls
//
//     looks, upwards   colours, and decals bottom to top
//     groups           bottom to top: decals of one colour, drawn as one mask
//     batches          of a group: no more volumes over any place than the stencil can count
//     drawn            volumes of a batch: near each other on the map are near each other here
#pragma once

#include <array>
#include <vector>

#include "decalgl/core/shared_array.h"
#include "decalgl/technique/technique.h"
#include "decalgl/technique/volume_options.h"
#include "technique/decal_looks.h"
#include "technique/shadow_volumes/lattice.h"
#include "terrain/height_ranges.h"

namespace decalgl::volume {

struct VolumeVertex {
    int32_t x;
    int32_t y;
    uint32_t heights;  // lowest | highest << 16, in steps
};
static_assert(sizeof(VolumeVertex) == 12, "a texel of RGB32I");

// As many vertices as 16 bits name the corners of.
constexpr uint32_t most_vertices = 1U << 15;

struct Volume {
    uint32_t decal;
    uint32_t first_vertex;  // that its corners are counted from: its own, or that of a volume before it
    uint32_t first_corner;
    uint32_t corner_count;
    uint32_t lid_corners;
    LatticeBox box;
    HeightRange heights;
};
static_assert(sizeof(Volume) == 44, "saved as it is");

struct Batch {
    uint32_t group;
    uint32_t first_drawn;
    uint32_t volume_count;
};

using Color = std::array<uint8_t, 4>;  // straight alpha

struct HeightSteps {
    float lowest = 0.0F;
    float step = 1.0F;
};

class PreparedVolumes : public Prepared {
public:
    PreparedCounts counts() const override;
    FeatureReference feature(uint32_t id) const override { return decals[id].feature; }
    std::vector<FeatureReference> query(const SeenPoint& seen) const override;
    bool shows_anything() const override { return !drawn.empty(); }
    void save(ArchiveWriter& archive, const std::string& prefix) const override;
    LayerLook look_of(uint32_t layer, size_t features) const override;
    // Other colours and another order: the meshes stay. Throws Error(style) for other widths.
    std::shared_ptr<const Prepared> restyled(Span<const LayerLook> looks,
                                             const MemoryAccount& memory) const override;
    // Throws Error(unsupported).
    std::shared_ptr<const Prepared> edited(const LayerEdit& edit, const MemoryAccount& memory) const override;

    bool shows(uint32_t decal) const { return looks[decal].shows(decals[decal].is_stroke()); }
    LatticePoint point(const Volume& volume, uint32_t corner) const {
        const VolumeVertex& vertex = vertices[volume.first_vertex + corners[corner] / 2U];
        return {vertex.x, vertex.y};
    }

    Lattice lattice;
    HeightSteps height_steps;
    Grouping grouping = Grouping::exact;
    uint32_t first_layer = 0;
    uint64_t features = 0;
    uint64_t segments = 0;
    SharedArray<OutlineOrder> outlines;  // of each layer from the first
    SharedArray<Decal> decals;
    SharedArray<uint32_t> first_volume_of;  // of each decal, and the end
    SharedArray<Volume> volumes;
    SharedArray<VolumeVertex> vertices;
    SharedArray<uint16_t> corners;

    SharedArray<PlainLook> looks;
    SharedArray<uint32_t> upwards;

    SharedArray<Color> groups;
    SharedArray<Batch> batches;
    SharedArray<uint32_t> drawn;
};

constexpr const char* prepared_name = "volume: prepared";

// Throws Error(unsupported) for styles that volumes cannot show and for polygons without triangles, Error(memory),
// Error(cancelled).
std::unique_ptr<const PreparedVolumes> build_volumes(const TechniqueInput& input, Progress& progress);

// What save() wrote. Throws Error(file).
std::unique_ptr<const PreparedVolumes> open_volumes(const ArchiveReader& archive, const std::string& prefix);

}  // namespace decalgl::volume

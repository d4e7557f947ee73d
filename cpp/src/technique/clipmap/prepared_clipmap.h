// What tiles are drawn from: triangles of polygons, and lines in the form that the solution asks for.
//
//     decals      bottom to top: colour and half width
//     chunks      bottom to top: runs of vertices of one decal, with the box that they can reach
//     vertices    triangles of polygons
//     lines       with a vertex more at either end: solutions 1, 3a, 4a
//     mesh        triangle strips: solutions 2, 3a, 3b
//     offsets     lines with offsets to the left and to the right: solution 4b
#pragma once

#include <array>
#include <vector>

#include "core/lattice_points.h"
#include "decalgl/core/large_array.h"
#include "decalgl/technique/clipmap_options.h"
#include "decalgl/technique/technique.h"
#include "technique/clipmap/virtual_texture.h"

namespace decalgl::clipmap {

using lattice::LatticeBox;

struct PlacedVertex {
    int32_t x;
    int32_t y;
    uint32_t decal;
};

struct OffsetVertex {
    int32_t x;
    int32_t y;
    uint32_t decal;
    std::array<float, 4> offsets;  // left x, y, right x, y in half widths; or radius and angle of each
};
static_assert(sizeof(PlacedVertex) == 12 && sizeof(OffsetVertex) == 28, "read by vertex shaders");

struct ClipmapDecal {
    std::array<uint8_t, 4> color;
    float half_width;  // metres; of fills 0
};

struct VertexRange {
    int32_t first = 0;
    int32_t count = 0;
};

struct Chunk {
    uint32_t decal;
    bool is_stroke;
    LatticeBox box;  // with the width
    VertexRange fill;
    VertexRange line;
    VertexRange mesh;
    VertexRange offsets;
};

class PreparedClipmap : public Prepared {
public:
    PreparedCounts counts() const override;
    FeatureReference feature(uint32_t) const override { return {}; }
    // Throw Error(unsupported): a texture holds colours, and what it was drawn from stays as it was prepared.
    std::vector<FeatureReference> query(const SeenPoint& point) const override;
    void save(ArchiveWriter& archive, const std::string& prefix) const override;
    LayerLook look_of(uint32_t layer, size_t features) const override;
    std::shared_ptr<const Prepared> restyled(Span<const LayerLook> looks,
                                             const MemoryAccount& memory) const override;
    std::shared_ptr<const Prepared> edited(const LayerEdit& edit, const MemoryAccount& memory) const override;
    bool shows_anything() const override { return !chunks.empty(); }

    VirtualTexture texture;
    ClipmapOptions options;
    std::vector<ClipmapDecal> decals;
    std::vector<Chunk> chunks;
    LargeArray<PlacedVertex> fills;
    LargeArray<PlacedVertex> lines;
    LargeArray<PlacedVertex> mesh;
    LargeArray<OffsetVertex> offsets;
    uint64_t features = 0;
    uint64_t segments = 0;
    MemoryCharge charge;
};

// Throws Error(unsupported) for styles that tiles are not drawn with and for polygons without triangles,
// Error(memory), Error(cancelled).
std::unique_ptr<const PreparedClipmap> build_clipmap(const TechniqueInput& input, Progress& progress);

}  // namespace decalgl::clipmap

// What tiles are drawn from: triangles of polygons, and lines in the form that the solution asks for.
//
//     geometry    shared with what it is restyled to
//       decals    as they came, each of chunks that follow each other
//       chunks    runs of vertices of one decal, with the box around them, which widths are added to
//       fills     triangles of polygons
//       lines     with a vertex more at either end: drawn by solutions 1, 3a, 4a, and what 2, 3b, 4b are tessellated from
//
//     looks, upwards    colours and widths, and decals bottom to top; `drawn` are the chunks of those that show
//     mesh              triangle strips: solutions 2, 3a, 3b
//     offsets           lines with offsets to the left and to the right: solution 4b
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/lattice_points.h"
#include "decalgl/core/large_array.h"
#include "decalgl/core/shared_array.h"
#include "decalgl/technique/clipmap_options.h"
#include "decalgl/technique/technique.h"
#include "technique/clipmap/virtual_texture.h"
#include "technique/decal_looks.h"

namespace decalgl::clipmap {

using lattice::LatticeBox;

constexpr int32_t chunk_segments = 64;

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

struct VertexRange {
    int32_t first = 0;
    int32_t count = 0;
};

struct Chunk {
    uint32_t decal;
    bool is_stroke;
    LatticeBox box;
    VertexRange fill;
    VertexRange line;
};

// A line, or a ring that ends with its first vertex.
struct Path {
    uint32_t decal;
    VertexRange line;  // without the vertices more
    uint32_t first_chunk;
    bool closed;
};

struct ClipmapGeometry {
    VirtualTexture texture;
    ClipmapOptions options;
    uint32_t first_layer = 0;
    std::vector<OutlineOrder> outlines;  // of each layer from the first
    std::vector<Decal> decals;
    std::vector<uint32_t> first_chunk_of;  // of each decal, and the end
    std::vector<Chunk> chunks;
    std::vector<Path> paths;
    LargeArray<PlacedVertex> fills;
    LargeArray<PlacedVertex> lines;
    uint64_t features = 0;
    uint64_t segments = 0;
    MemoryCharge charge;

    bool draws_lines() const;
    bool has_mesh() const;
    bool has_offsets() const;
    // Whether another width asks for other vertices: the corners of meshes move, and inner borders may meet or not.
    bool is_tessellated_anew() const {
        return has_mesh() || (has_offsets() && options.joints == JointMethod::inner_meets);
    }
    uint64_t bytes() const;
};

// Lines as triangles, or ready to become some. A pair of corners is two vertices of the mesh, or one with offsets.
struct Tessellation {
    SharedArray<VertexRange> pairs;  // of each chunk
    SharedArray<PlacedVertex> mesh;
    SharedArray<OffsetVertex> offsets;
};

class PreparedClipmap : public Prepared {
public:
    PreparedCounts counts() const override;
    FeatureReference feature(uint32_t) const override { return {}; }
    // Throws Error(unsupported): a texture holds colours.
    std::vector<FeatureReference> query(const SeenPoint& point) const override;
    // Throws Error(unsupported): preparing takes little more than reading would.
    void save(ArchiveWriter& archive, const std::string& prefix) const override;
    LayerLook look_of(uint32_t layer, size_t features) const override;
    // Other colours, widths and another order; lines are tessellated anew where widths ask for it.
    std::shared_ptr<const Prepared> restyled(Span<const LayerLook> looks,
                                             const MemoryAccount& memory) const override;
    // Throws Error(unsupported).
    std::shared_ptr<const Prepared> edited(const LayerEdit& edit, const MemoryAccount& memory) const override;
    bool shows_anything() const override { return !drawn.empty(); }

    // The chunks that are drawn, bottom to top.
    void order_chunks();

    std::shared_ptr<const ClipmapGeometry> geometry;
    std::vector<PlainLook> looks;
    std::vector<uint32_t> upwards;
    std::vector<uint32_t> drawn;
    Tessellation tessellation;
};

constexpr const char* prepared_name = "clipmap: prepared";

// Throws Error(unsupported) for styles that tiles are not drawn with and for polygons without triangles,
// Error(memory), Error(cancelled).
std::unique_ptr<const PreparedClipmap> build_clipmap(const TechniqueInput& input, Progress& progress);

// The lines in widths so many times as large as the looks say. Throws Error(memory).
Tessellation tessellate(const ClipmapGeometry& geometry, Span<const PlainLook> looks, double wider,
                        const MemoryAccount& memory);

}  // namespace decalgl::clipmap

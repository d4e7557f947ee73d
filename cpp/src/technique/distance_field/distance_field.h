// Networks by distance fields, after Trapp et al. 2015, over terrain.
//
//     segments ─▶ boxes ─▶ fields: cross distance, length, depth ─▶ styles ─▶ picture
//     points      geometry  a layer for each category, the least    one pass
//                 shader
//
// The paper's networks are planar. Here a segment's box holds all the ground under it, and what a pixel of it is away
// from the line follows from the place on the map that the G-buffer has for the pixel.
#pragma once

#include <memory>

#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "gl/vertex_array.h"
#include "shared/view_block.h"
#include "technique/distance_field/field_targets.h"
#include "technique/distance_field/prepared_network.h"

namespace decalgl {

class DistanceField : public Technique {
public:
    std::string name() const override { return "distance_field"; }
    std::unique_ptr<const Prepared> preprocess(const TechniqueInput& input,
                                               Progress& progress) const override;
    std::unique_ptr<const Prepared> open(const ArchiveReader& archive, const std::string& prefix,
                                         const MemoryAccount& memory) const override;
    void upload(std::shared_ptr<const Prepared> prepared, std::shared_ptr<const Prepared> lens,
                const TerrainView& terrain, const MemoryAccount& memory) override;
    UpdateReport update(const View& view) override;
    SlopeUse slope_use() const override;
    bool keeps_update() const override { return holds_fields(outside_); }
    void draw(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) override;
    void draw_ids(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) override;

private:
    // The network on the GPU; a lens shares it, unless mends differ.
    struct NetworkBuffers {
        std::shared_ptr<const network::Network> network;
        gl::TextureBuffer nodes;
        gl::Buffer segments;
        gl::VertexArray points;

        void upload(const std::shared_ptr<const network::Network>& from, const MemoryAccount& memory);
        size_t bytes() const { return nodes.buffer().bytes() + segments.bytes(); }
    };

    // What is seen outside the lens, or inside.
    struct Side {
        std::shared_ptr<const network::PreparedNetwork> prepared;
        std::shared_ptr<NetworkBuffers> buffers;
        gl::TextureBuffer slots;
        gl::TextureBuffer styles;
        gl::Texture2D drop_offs;
        gl::Texture2D rasters;
        gl::Texture2D lod;

        size_t bytes() const;
    };

    enum class LensSide : int { outside, inside };

    void upload_side(std::shared_ptr<const Prepared> prepared, Side& side) const;
    gl::Flags flags_of(const Side& side) const;
    network::FieldFormat format_for(const Side& side, const View& view, const GBufferView& gbuffer) const;
    void draw_fields(const Side& side, const View& view, const GBufferView& gbuffer,
                     gl::ProgramLibrary& programs);
    void draw_fields_again(const Side& side, const View& view, const GBufferView& gathered,
                           gl::ProgramLibrary& programs);
    void draw_boxes(const Side& side, const gl::Flags& flags, const View& view, const GBufferView& gbuffer,
                    gl::ProgramLibrary& programs, LensSide lens_side) const;
    void stylize(const Side& side, const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs,
                 LensSide lens_side);
    void set_styles(const Side& side, const View& view, const GBufferView& gbuffer,
                    gl::Program& program) const;

    // What the fields were drawn from last. Of the G-buffer, texels that are gathered from it are read.
    struct Drawn {
        const gl::Texture2D* position = nullptr;
        const gl::Texture2D* surface = nullptr;
        std::shared_ptr<const network::PreparedNetwork> prepared;
        ViewBlock block;
    };

    bool holds_fields(const Side& side) const;

    Side outside_;
    Side inside_;
    network::FieldTargets targets_;
    Drawn drawn_;
    gl::VertexArray no_vertices_;
    MemoryAccount memory_;
};

}  // namespace decalgl

// Clipmap textures: vectors drawn into tiles of a virtual texture, as finely as each part of the picture asks for.
//
// After Taibo et al. 2014, over the textures of Taibo et al. 2009 and the clipmap of Tanner et al. 1998.
//
//     pixels ─▶ tiles needed ─▶ those not there are drawn ─▶ each pixel samples between two levels
#pragma once

#include "decalgl/technique/technique.h"
#include "decalgl/terrain/heightfield.h"
#include "technique/clipmap/tile_painter.h"

namespace decalgl {

class Clipmap : public Technique {
public:
    std::string name() const override { return "clipmap"; }
    std::unique_ptr<const Prepared> preprocess(const TechniqueInput& input,
                                               Progress& progress) const override;
    std::unique_ptr<const Prepared> open(const ArchiveReader& archive, const std::string& prefix,
                                         const MemoryAccount& memory) const override;
    void upload(std::shared_ptr<const Prepared> prepared, std::shared_ptr<const Prepared> lens,
                const TerrainView& terrain, const MemoryAccount& memory) override;
    UpdateReport update(const View& view) override;
    void draw(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) override;
    void draw_ids(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) override;

private:
    enum class LensSide : int { outside, inside };

    // What is seen outside the lens, or inside.
    struct Side {
        std::shared_ptr<const clipmap::PreparedClipmap> prepared;
        clipmap::TilePainter painter;
        clipmap::TileStore store;
        double wider = 1.0;

        size_t bytes() const { return painter.bytes() + store.bytes(); }
    };

    void update_side(const View& view, Side& side);
    double wider_for(const View& view, const clipmap::ClipmapOptions& options) const;
    void set_place(const View& view, const GBufferView& gbuffer, gl::Program& program) const;
    std::vector<clipmap::Tile> needed_tiles(const View& view, const GBufferView& gbuffer,
                                            gl::ProgramLibrary& programs);
    void draw_tiles(const View& view, std::vector<clipmap::Tile> needed, Side& side,
                    gl::ProgramLibrary& programs);
    void draw_side(const View& view, const GBufferView& gbuffer, LensSide lens_side,
                   gl::ProgramLibrary& programs);

    Side outside_;
    Side inside_;  // nothing prepared: no lens
    Heightfield terrain_;
    MemoryAccount memory_;
    gl::Texture2D feedback_;
    gl::Framebuffer feedback_framebuffer_;
    gl::VertexArray no_vertices_;
    bool in_areas_ = false;  // the picture in hand is one of coverage
};

}  // namespace decalgl

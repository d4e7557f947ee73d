// Static decals: polygons and lines of world size, decided for each pixel from a grid of cells.
#pragma once

#include "decalgl/technique/technique.h"
#include "gl/buffer.h"
#include "gl/growing_buffer.h"
#include "gl/program.h"
#include "gl/vertex_array.h"
#include "technique/static_decals/level_textures.h"
#include "technique/static_decals/prepared_decals.h"

namespace decalgl {

class StaticDecals : public Technique {
public:
    std::string name() const override { return "static"; }
    std::unique_ptr<const Prepared> preprocess(const TechniqueInput& input,
                                               Progress& progress) const override;
    std::unique_ptr<const Prepared> open(const ArchiveReader& archive, const std::string& prefix,
                                         const MemoryAccount& memory) const override;
    void upload(std::shared_ptr<const Prepared> prepared, std::shared_ptr<const Prepared> lens,
                const TerrainView&, const MemoryAccount& memory) override;
    UpdateReport update(const View& view) override;
    SlopeUse slope_use() const override;
    bool needs_depth(const View& view) const override { return view.antialias == Antialias::coverage; }
    void draw(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) override;
    void draw_ids(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) override;

private:
    void upload_styles(const PreparedDecals* prepared, const PreparedDecals* lens);
    void upload_records(const PreparedDecals& prepared, const PreparedDecals* lens);
    bool has_styles() const;
    // What is seen outside the lens, and inside.
    template <typename HoldsFor>
    bool any_look(HoldsFor holds_for) const {
        return holds_for(*prepared_) || (lens_ && holds_for(*lens_));
    }
    void add_style_flags(gl::Flags& flags) const;
    void make_records();
    void draw_areas(const gl::Flags& flags, CoverageRule rule, const GBufferView& gbuffer,
                    gl::ProgramLibrary& programs);
    void draw_full_screen(gl::Flags flags, const GBufferView& gbuffer, gl::ProgramLibrary& programs);

    std::shared_ptr<const PreparedDecals> prepared_;
    std::shared_ptr<const PreparedDecals> lens_;  // null without one
    MemoryAccount memory_;
    gl::TextureBuffer buckets_;
    gl::GrowingBuffer cells_;
    gl::GrowingBuffer texels_;
    gl::GrowingBuffer lens_texels_;            // where another draw order holds inside the lens
    gl::TextureBuffer styles_;                 // those inside the lens follow the others
    gl::TextureBuffer kinds_, style_records_;  // where some decal is not plain; those inside the lens too
    gl::TextureBuffer half_planes_;            // which samples lie in one, by direction and distance
    std::unique_ptr<LevelTextures> levels_;
    gl::VertexArray no_vertices_;
};

}  // namespace decalgl

// Static decals: polygons and lines of world size, decided for each pixel from a grid of cells.
#pragma once

#include "decalgl/technique/technique.h"
#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "gl/vertex_array.h"
#include "technique/static_decals/prepared_decals.h"

namespace decalgl {

class StaticDecals : public Technique {
public:
    std::string name() const override { return "static"; }
    std::unique_ptr<const Prepared> preprocess(const TechniqueInput& input,
                                               Progress& progress) const override;
    std::unique_ptr<const Prepared> open(const ArchiveReader& archive, const std::string& prefix,
                                         const MemoryAccount& memory) const override;
    void upload(std::shared_ptr<const Prepared> prepared, const MemoryAccount& memory) override;
    UpdateReport update(const View& view) override;
    bool needs_depth(const View& view) const override { return view.antialias == Antialias::coverage; }
    void draw(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) override;
    void draw_ids(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) override;

private:
    bool needs_levels(const View& view) const;
    void make_levels();
    void draw_areas(const gl::Flags& flags, const GBufferView& gbuffer, gl::ProgramLibrary& programs);
    void draw_full_screen(gl::Flags flags, const GBufferView& gbuffer, gl::ProgramLibrary& programs);

    std::shared_ptr<const PreparedDecals> prepared_;
    MemoryAccount memory_;
    gl::TextureBuffer buckets_;
    gl::TextureBuffer cells_;
    gl::TextureBuffer texels_;
    gl::TextureBuffer styles_;
    gl::TextureBuffer kinds_, style_records_;  // where some decal is not plain
    gl::TextureBuffer half_planes_;            // which samples lie in one, by direction and distance
    gl::Texture2D levels_;                     // made by the first view that needs them
    bool draws_levels_ = false;
    gl::VertexArray no_vertices_;
};

}  // namespace decalgl

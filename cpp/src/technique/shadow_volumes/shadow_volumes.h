// Shadow volumes: decals as closed meshes around the terrain, counted in the stencil.
//
// After Schneider and Klein 2007, as Zechmeister 2020, sections 2.4 and 5.2.2, compares with: each mask is counted from
// behind (z-fail), so that it is right with the eye inside of a volume.
//
//     depth ─▶ for each group:  count its batches ─▶ lay its colour over what they cover
#pragma once

#include "decalgl/technique/technique.h"
#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/vertex_array.h"
#include "technique/shadow_volumes/prepared_volumes.h"
#include "technique/shadow_volumes/volume_view.h"

namespace decalgl {

class ShadowVolumes : public Technique {
public:
    std::string name() const override { return "volume"; }
    std::unique_ptr<const Prepared> preprocess(const TechniqueInput& input,
                                               Progress& progress) const override;
    std::unique_ptr<const Prepared> open(const ArchiveReader& archive, const std::string& prefix,
                                         const MemoryAccount& memory) const override;
    void upload(std::shared_ptr<const Prepared> prepared, std::shared_ptr<const Prepared> lens,
                const TerrainView& terrain, const MemoryAccount& memory) override;
    UpdateReport update(const View& view) override;
    bool needs_stencil(const View&) const override { return true; }
    void draw(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) override;
    void draw_ids(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) override;

private:
    // What is seen outside the lens, or inside.
    enum class LensSide : int { outside, inside };

    // Calls back with what is seen on each side of the lens, after its depth was drawn.
    template <typename SideFn>
    void draw_sides(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs,
                    SideFn draw_side);
    void begin(LensSide side, const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs);
    static void end();
    void draw_groups(const volume::PreparedVolumes& prepared, gl::ProgramLibrary& programs);
    void draw_decals(const volume::PreparedVolumes& prepared, gl::ProgramLibrary& programs);
    // Counts volumes [first, end) of a list that are in the view; false where none is.
    template <typename VolumeAt>
    bool count(uint32_t first, uint32_t end, VolumeAt volume_at, gl::Program& program);
    void fold();
    void lay_mask();
    void draw_full_screen();

    std::shared_ptr<const volume::PreparedVolumes> outside_;
    std::shared_ptr<const volume::PreparedVolumes> inside_;  // shares the meshes; null without a lens
    const volume::VolumeVertex* uploaded_ = nullptr;
    gl::TextureBuffer vertices_;
    gl::Buffer corners_;
    gl::VertexArray mesh_;
    gl::VertexArray no_vertices_;
    volume::VolumeView seen_;      // of the view in hand
    volume::ScreenBox in_hand_;    // where the volumes that are counted may show
    std::vector<GLsizei> counts_;  // of runs of volumes that are next to each other
    std::vector<const void*> starts_;
    std::vector<GLint> first_vertices_;
};

}  // namespace decalgl

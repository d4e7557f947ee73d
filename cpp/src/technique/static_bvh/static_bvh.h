// Static decals by the published structures: Zechmeister's and, with other options, Thöny's.
#pragma once

#include "decalgl/technique/technique.h"
#include "gl/growing_buffer.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "gl/vertex_array.h"
#include "technique/static_bvh/prepared_bvh.h"

namespace decalgl {

class StaticBvh : public Technique {
public:
    std::string name() const override { return "static_bvh"; }
    std::unique_ptr<const Prepared> preprocess(const TechniqueInput& input,
                                               Progress& progress) const override;
    std::unique_ptr<const Prepared> open(const ArchiveReader& archive, const std::string& prefix,
                                         const MemoryAccount& memory) const override;
    void upload(std::shared_ptr<const Prepared> prepared, std::shared_ptr<const Prepared> lens,
                const TerrainView&, const MemoryAccount& memory) override;
    UpdateReport update(const View& view) override;
    SlopeUse slope_use() const override;
    void draw(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) override;
    void draw_ids(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) override;

private:
    // A buffer with the name that the shaders give it.
    struct NamedBuffer {
        const char* name;
        std::shared_ptr<gl::GrowingBuffer> buffer;
    };

    // An index, and the buffers of each of its groups.
    struct Look {
        std::shared_ptr<const bvh::PreparedBvh> prepared;
        std::vector<std::vector<NamedBuffer>> buffers;
    };

    // Rows of the picture, and which samples of its pixels, at places that follow these borders.
    struct Strip {
        int first_row = 0;
        const gl::Texture2D* borders = nullptr;
        int first_sample = 0;
        int end_sample = 0;
    };

    // A picture to be drawn into and to be drawn.
    struct Canvas {
        gl::Texture2D picture;
        gl::Framebuffer target;
    };

    struct Run;

    void upload(std::shared_ptr<const bvh::PreparedBvh> prepared, Look& look, const Look* other) const;
    void draw_look(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs);
    void draw_through_lens(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs);
    Canvas canvas(GLenum format, int width, int height, const gl::Texture2D* depth = nullptr) const;
    std::vector<Run> runs_of(const View& view) const;
    void lay(const Canvas& from, int first_row, float share, gl::ProgramLibrary& programs) const;
    void find_borders(const Canvas& borders, const std::vector<Run>& runs, int row, const View& view,
                      const GBufferView& gbuffer, gl::ProgramLibrary& programs);
    void draw_runs(const std::vector<Run>& runs, const gl::Flags& flags, Strip strip, const View& view,
                   const GBufferView& gbuffer, gl::ProgramLibrary& programs);
    void add_samples(const Canvas& sum, const Canvas& sample, const std::vector<Run>& runs, Strip strip,
                     const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs);
    void draw_samples(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs);
    void draw_groups(size_t begin, size_t end, const gl::Flags& flags, Strip strip, const View& view,
                     const GBufferView& gbuffer, gl::ProgramLibrary& programs);
    void draw_group(size_t group, gl::Flags flags, Strip strip, const View& view, const GBufferView& gbuffer,
                    gl::ProgramLibrary& programs);
    gl::Flags flags_of(const bvh::DecalGroup& group) const;

    Look outside_, inside_;  // the lens; nothing is inside without one
    const Look* drawn_ = &outside_;
    gl::VertexArray no_vertices_;
    MemoryAccount memory_;
};

}  // namespace decalgl

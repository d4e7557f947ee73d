// Static decals by the published structures: Zechmeister's and, with other options, Thöny's.
#pragma once

#include "decalgl/technique/technique.h"
#include "gl/buffer.h"
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
    void draw(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) override;
    void draw_ids(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) override;

private:
    // A buffer with the name that the shaders give it.
    struct NamedBuffer {
        const char* name;
        gl::TextureBuffer buffer;
    };

    // Rows of the picture, and which sample of its pixels.
    struct Strip {
        int first_row;
        int sample;
    };

    // A picture to be drawn into and to be drawn.
    struct Canvas {
        gl::Texture2D picture;
        gl::Framebuffer target;
    };

    struct Run;

    Canvas canvas(int width, int height) const;
    std::vector<Run> runs_of(const View& view) const;
    void draw_samples(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs);
    void draw_groups(size_t begin, size_t end, const gl::Flags& flags, Strip strip, const View& view,
                     const GBufferView& gbuffer, gl::ProgramLibrary& programs);
    void draw_group(size_t group, gl::Flags flags, Strip strip, const View& view, const GBufferView& gbuffer,
                    gl::ProgramLibrary& programs);
    gl::Flags flags_of(const bvh::DecalGroup& group) const;

    std::shared_ptr<const bvh::PreparedBvh> prepared_;
    std::vector<std::vector<NamedBuffer>> buffers_;  // of each group
    gl::VertexArray no_vertices_;
    MemoryAccount memory_;
};

}  // namespace decalgl

// LOOPS as a technique: polygons and lines simplified where and as much as the view allows.
//
// After Amiraghdam, Diehl and Pajarola: docs/techniques/loops.md.
#pragma once

#include <optional>

#include "decalgl/technique/technique.h"
#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/vertex_array.h"
#include "technique/loops/prepared_loops.h"
#include "technique/loops/view_cells.h"
#include "technique/loops/view_detail.h"

namespace decalgl {

class Loops : public Technique {
public:
    std::string name() const override { return "loops"; }
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
    // What the cells were made for.
    struct CellsKey {
        loops::Sight sight;
        DetailEye eye;
        LoopsDetail detail;
        std::shared_ptr<const loops::Slots> slots;
    };

    void upload_bvh();
    template <typename Values>
    void add_buffer(const char* name, GLenum format, const Values& values);
    void make_cells(const View& view);
    void add_flags(gl::Flags& flags) const;
    void draw_with(gl::Flags flags, const View& view, const GBufferView& gbuffer,
                   gl::ProgramLibrary& programs);
    void set_bvh(gl::Program& program, const View& view) const;
    void set_cells(gl::Program& program) const;
    void set_detail(gl::Program& program, const View& view) const;

    MemoryAccount memory_;
    std::shared_ptr<const loops::PreparedLoops> prepared_;
    std::shared_ptr<const loops::LoopsIndex> uploaded_;
    std::shared_ptr<const loops::Slots> uploaded_slots_;
    std::vector<NamedBuffer> buffers_;
    std::optional<CellsKey> key_;
    loops::ViewCells cells_;  // without its lists, which are on the GPU
    gl::VertexArray no_vertices_;
};

}  // namespace decalgl

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
    void forget_view() override;
    void draw(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) override;
    void draw_ids(const View& view, const GBufferView& gbuffer, gl::ProgramLibrary& programs) override;

private:
    // A buffer with the name that the shaders give it.
    struct NamedBuffer {
        const char* name;
        gl::TextureBuffer buffer;
    };
    // The cells of a view, and what they were made for.
    struct Cells {
        loops::Sight sight;
        DetailEye eye;
        LoopsDetail detail;
        loops::ViewCells cells;  // without its lists, which are on the GPU
        std::vector<NamedBuffer> buffers;

        bool serve(const Cells& wanted, const loops::Slots& slots) const;
    };
    // What is seen outside the lens, or inside.
    enum class LensSide : int { outside, inside };
    struct Side {
        std::shared_ptr<const loops::PreparedLoops> prepared;
        SharedArray<loops::Style> uploaded;
        NamedBuffer styles{};
        std::shared_ptr<const Cells> cells;  // both sides may have the same; none where there is a bvh
    };

    void upload_bvh(const loops::LoopsIndex& index);
    void upload_side(std::shared_ptr<const Prepared> prepared, Side& side);
    template <typename Values>
    NamedBuffer buffer_of(const char* name, GLenum format, const Values& values) const;
    void make_cells(const View& view, Side& side);
    std::shared_ptr<const Cells> cells_of(const View& view, Cells wanted,
                                          const loops::PreparedLoops& prepared) const;
    void add_flags(const Side& side, gl::Flags& flags) const;
    void draw_sides(const gl::Flags& flags, const View& view, const GBufferView& gbuffer,
                    gl::ProgramLibrary& programs);
    void draw_side(LensSide lens_side, gl::Flags flags, const View& view, const GBufferView& gbuffer,
                   gl::ProgramLibrary& programs) const;
    void set_bvh(gl::Program& program, const View& view, const LoopsDetail& detail) const;
    void set_detail(gl::Program& program, const View& view, const LoopsDetail& detail) const;

    MemoryAccount memory_;
    std::shared_ptr<const loops::LoopsIndex> uploaded_;
    std::vector<NamedBuffer> bvh_;
    Side outside_, inside_;  // without a lens, nothing is inside
    gl::VertexArray no_vertices_;
};

}  // namespace decalgl

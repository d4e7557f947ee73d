// Draws tiles from the vectors: polygons, and lines by the solution that the options name (Taibo et al. 2014, section 4).
#pragma once

#include <vector>

#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "gl/vertex_array.h"
#include "technique/clipmap/prepared_clipmap.h"
#include "technique/clipmap/tile_store.h"

namespace decalgl::clipmap {

class TilePainter {
public:
    // From now on draws these, in widths so many times as large; uploads what is not there yet.
    void use(std::shared_ptr<const PreparedClipmap> prepared, double wider, const MemoryAccount& memory);
    void draw(const Tile& tile, const TileStore& store, gl::ProgramLibrary& programs);
    size_t bytes() const;

private:
    enum class Form { fill, line, mesh, wire, adjacent, offsets, thin_offsets };

    // Vertices on the GPU, and the array that they came from.
    struct Vertices {
        gl::Buffer buffer;
        gl::VertexArray array;
        const void* from = nullptr;

        template <typename Values>
        void upload(const Values& values, const MemoryAccount& memory);
    };

    Form form_of(const Chunk& chunk, double texels) const;
    VertexRange range_of(size_t chunk, Form form) const;
    void make_canvas(const MemoryAccount& memory);
    void draw_run(Form form, double texels, const Tile& tile, gl::ProgramLibrary& programs);
    const Vertices& vertices_of(Form form) const;

    std::shared_ptr<const PreparedClipmap> prepared_;
    double wider_ = 1.0;
    Tessellation tessellation_;  // of the widths in hand
    gl::TextureBuffer decals_;
    Vertices fills_, lines_, mesh_, offsets_;
    gl::Texture2D canvas_;
    gl::Framebuffer canvas_framebuffer_;
    gl::ObjectHandle layer_framebuffer_;
    std::vector<GLint> firsts_;
    std::vector<GLsizei> counts_;
};

}  // namespace decalgl::clipmap

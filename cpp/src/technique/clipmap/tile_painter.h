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
    TilePainter() = default;
    TilePainter(const PreparedClipmap& prepared, const MemoryAccount& memory);

    void draw(const PreparedClipmap& prepared, const Tile& tile, const TileStore& store,
              gl::ProgramLibrary& programs);
    size_t bytes() const;

private:
    enum class Form { fill, line, mesh, wire, adjacent, offsets, thin_offsets };

    static Form form_of(const PreparedClipmap& prepared, const Chunk& chunk, double texels);
    static VertexRange range_of(const Chunk& chunk, Form form);
    void draw_run(const PreparedClipmap& prepared, Form form, double texels, const Tile& tile,
                  gl::ProgramLibrary& programs);

    gl::TextureBuffer decals_;
    gl::Buffer fills_, lines_, mesh_, offsets_;
    gl::VertexArray fill_array_, line_array_, mesh_array_, offset_array_;
    gl::Texture2D canvas_;
    gl::Framebuffer canvas_framebuffer_;
    gl::ObjectHandle layer_framebuffer_;
    std::vector<GLint> firsts_;
    std::vector<GLsizei> counts_;
};

}  // namespace decalgl::clipmap

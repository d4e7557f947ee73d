// The lens's mask: for each pixel of a rectangle the share of it that is inside, and whether its centre is.
#pragma once

#include <memory>
#include <vector>

#include "decalgl/frame/lens.h"
#include "decalgl/frame/picture_request.h"
#include "frame/gbuffer.h"
#include "frame/silhouettes.h"
#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "gl/vertex_array.h"

namespace decalgl {

struct LensEdge {
    double x0, y0, x1, y1;
};
std::vector<LensEdge> edges_of(const Lens& lens);

class LensMask {
public:
    // Draws the mask of what the G-buffer holds: a rectangle, or samples that `gathered` tells the places of.
    void draw(const std::shared_ptr<const Lens>& lens, const PictureRequest& request,
              const PositionGrid& positions, const GBuffer& gbuffer, const Silhouettes* gathered,
              gl::ProgramLibrary& programs, const MemoryAccount& memory);
    const gl::Texture2D& texture() const { return mask_; }

private:
    void upload_edges(const PositionGrid& positions, const MemoryAccount& memory);

    std::shared_ptr<const Lens> lens_;  // whose edges are uploaded
    gl::TextureBuffer edges_;           // metres from the block's lower left corner
    int64_t block_x_ = 0;
    int64_t block_y_ = 0;
    gl::Texture2D mask_;
    gl::Framebuffer framebuffer_;
    gl::VertexArray no_vertices_;
};

}  // namespace decalgl

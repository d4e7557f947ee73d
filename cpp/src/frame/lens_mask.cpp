#include "frame/lens_mask.h"

#include <cmath>

#include "gl/gl.h"

namespace decalgl {

// Counted from a block near the rings, so that float32 is enough.
void LensMask::upload_edges(const PositionGrid& positions, const MemoryAccount& memory) {
    const std::vector<LensEdge> edges = edges_of(*lens_);
    block_x_ = std::llround((edges.front().x0 - positions.origin_x) / positions.block_size);
    block_y_ = std::llround((edges.front().y0 - positions.origin_y) / positions.block_size);
    const double left = positions.origin_x + static_cast<double>(block_x_) * positions.block_size;
    const double bottom = positions.origin_y + static_cast<double>(block_y_) * positions.block_size;
    std::vector<glm::vec4> local;
    for (const LensEdge& edge : edges)
        local.emplace_back(edge.x0 - left, edge.y0 - bottom, edge.x1 - left, edge.y1 - bottom);
    edges_ = gl::TextureBuffer::from(memory, "frame: lens", GL_RGBA32F, local);
}

void LensMask::draw(const std::shared_ptr<const Lens>& lens, const PictureRequest& request,
                    const PositionGrid& positions, const GBuffer& gbuffer, const Silhouettes* gathered,
                    gl::ProgramLibrary& programs, const MemoryAccount& memory) {
    if (!mask_ || mask_.width() != gbuffer.width() || mask_.height() != gbuffer.height()) {
        mask_ = gl::Texture2D::create(memory, "frame: lens", GL_RG8, gbuffer.width(), gbuffer.height());
        framebuffer_ = gl::Framebuffer::create("lens", {{GL_COLOR_ATTACHMENT0, &mask_}});
        no_vertices_ = gl::VertexArray::create();
    }
    const bool is_new = lens_ != lens;
    lens_ = lens;
    gl::Flags flags;
    if (lens->is_on_map())
        flags.insert("ON_MAP");
    if (gathered != nullptr)
        flags.insert("GATHERED");
    gl::Program& program = programs.get("lens", flags);
    framebuffer_.bind();
    program.use();
    if (gathered != nullptr)
        gathered->set_gathered(program);
    if (lens->is_on_map()) {
        if (is_new)
            upload_edges(positions, memory);
        program.set("position_texture", 0);
        gbuffer.position.bind(0);
        program.set("surface_texture", 1);
        gbuffer.surface.bind(1);
        program.set("lens_edges", 2);
        edges_.bind(2);
        program.set("edge_count", static_cast<int>(edges_.texels()));
        program.set("lens_block", glm::ivec2(block_x_, block_y_));
    } else {
        program.set("circle", glm::vec3(lens->x, request.height - lens->y, lens->radius));
    }
    no_vertices_.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace decalgl

// Pixels through which a silhouette of the terrain passes, or a crease beside a border of a feature, drawn anew as
// the mean of samples.
//
//     G-buffer, overlay ─▶ marks ─▶ list ─▶ 16 rays a pixel ─▶ G-buffer of 64 texels a pixel ─▶ overlay ─▶ compose ─▶ means
//                                   CPU     terrain/gathered   terrain/spread; at silhouettes, and where the rays met many facets
//                                                              (terrain/facets), a ray for each texel
//
// Such pixels are few, so what they see is gathered in textures of its own, batch after batch, and neither the
// terrain's triangles nor the rest of the picture are touched again.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "decalgl/frame/picture_request.h"
#include "decalgl/technique/technique.h"
#include "frame/targets.h"
#include "frame/terrain_mesh.h"
#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/vertex_array.h"

namespace decalgl {

class Silhouettes {
public:
    // For rectangles of at most this size.
    Silhouettes(int width, int height, bool has_overlay, const MemoryAccount& memory);

    // The pixels of `shown` that need it, x | y << 16 counted from the rectangle drawn. The uniform block is
    // that of the pixels' centres. overlay: none where creases are left alone.
    std::vector<uint32_t> find(const GBuffer& centres, const gl::Texture2D* overlay, SlopeUse slope_use,
                               const Rectangle& drawn, const Rectangle& shown, const TerrainMesh& terrain,
                               gl::ProgramLibrary& programs);

    static constexpr size_t batch_size = 8192;
    // Makes a batch of pixels the ones that programs with the flag GATHERED see.
    void gather(Span<const uint32_t> pixels);
    void set_gathered(gl::Program& program) const;
    // The same for the program that follows the batch's rays, into `rays()`.
    void set_rays(gl::Program& program) const;
    // In which pixels each sample needs a ray of its own.
    void count_facets(gl::ProgramLibrary& programs) const;
    // The samples on what the rays met, into `seen()`, with depth 1 where they need rays of their own.
    void spread(gl::ProgramLibrary& programs);
    // The texels across, and the rows of them that the batch fills, of `rays()` and `seen()`.
    int ray_columns() const;
    int ray_rows() const;
    int sample_columns() const;
    int sample_rows() const;

    const GBuffer& rays() const { return rays_; }
    const SeenTargets& seen() const { return *seen_; }
    const gl::Framebuffer& composed() const { return composed_framebuffer_; }
    // Of the batch's pixels, R, G, B, A with straight alpha, once it is composed.
    std::vector<uint8_t> means(gl::ProgramLibrary& programs);

private:
    void make_batch_targets();
    int used_rows() const;  // of pixels
    void set_pixels(gl::Program& program) const;

    MemoryAccount memory_;
    bool has_overlay_ = false;
    gl::VertexArray no_vertices_;
    gl::Texture2D marks_;
    gl::Framebuffer marks_framebuffer_;
    gl::TextureBuffer pixels_;
    size_t count_ = 0;
    GBuffer rays_;  // made when first needed, as what follows
    gl::Texture2D too_few_;
    gl::Framebuffer too_few_framebuffer_;
    std::unique_ptr<SeenTargets> seen_;
    gl::Texture2D composed_;
    gl::Framebuffer composed_framebuffer_;
    gl::Texture2D means_;
    gl::Framebuffer means_framebuffer_;
};

}  // namespace decalgl

// The pipeline: one scene's objects in one GL context, and the passes that make a picture of them.
//
//     for each rectangle:  G-buffer ─▶ overlay, one pass a technique ─▶ compose ─▶ read back
//
// A picture larger than a rectangle is drawn piece by piece with the projection and the levels of detail of
// the whole, so the pieces fit without a seam.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "decalgl/frame/picture_request.h"
#include "decalgl/frame/renderer.h"
#include "frame/gbuffer.h"
#include "frame/lens_mask.h"
#include "frame/prepared_scene.h"
#include "frame/terrain_mesh.h"
#include "gl/context.h"

namespace decalgl {

class Pipeline {
public:
    explicit Pipeline(const RendererOptions& options, const MemoryAccount& memory);

    gl::Context& context() { return *context_; }

    // Uploads what is not there yet and sets the view up. Throws Error(memory) where the picture is larger
    // than the driver can draw or the budget holds.
    UpdateReport update(std::shared_ptr<const PreparedScene> scene, const PictureRequest& request);
    // The same, but what was drawn of the surface stays where scene and view still show it.
    UpdateReport update_layers(std::shared_ptr<const PreparedScene> scene, const PictureRequest& request);

    // Everything below draws what update() was last given; arrays have row 0 at the top.
    std::vector<uint8_t> draw_image();
    // Of each pass from bottom to top: 1 + id at each pixel's centre, 0 where there is none.
    std::vector<std::vector<uint32_t>> draw_ids();
    void draw_surface(std::vector<double>& world, std::vector<float>& depth);
    // Milliseconds that the floor pass takes, for benchmarks.
    double time_floor();

    bool draws(const PreparedScene* scene, const PictureRequest& request) const;
    TimingLog& timings() { return timings_; }
    std::vector<std::string> variants() const { return programs_.variants(); }
    uint64_t triangles() const { return triangles_; }

private:
    using RectangleFn = std::function<void(const Rectangle&)>;

    void upload(std::shared_ptr<const PreparedScene> scene);
    void upload_layers(const PreparedScene& scene);
    void set_view();
    bool has_lens() const;
    GBufferView look_through_lens();
    void choose_rectangles();
    void make_targets();
    void for_each_rectangle(const RectangleFn& body);
    void draw_gbuffer(const Rectangle& rectangle);
    void draw_overlay();
    void compose();

    MemoryAccount memory_;
    std::unique_ptr<gl::Context> context_;
    gl::ProgramLibrary programs_;
    RendererOptions options_;
    TimingLog timings_{true};

    std::shared_ptr<const PreparedScene> scene_;
    std::unique_ptr<TerrainMesh> terrain_;
    std::vector<std::unique_ptr<Technique>> techniques_;

    PictureRequest request_;
    View view_;
    ViewBlock view_block_{};
    gl::Buffer view_buffer_;
    gl::VertexArray no_vertices_;
    std::vector<VisibleTile> tiles_;
    std::vector<Rectangle> rectangles_;
    uint64_t triangles_ = 0;

    GBuffer gbuffer_;
    LensMask lens_mask_;
    const void* drawn_in_gbuffer_ = nullptr;  // the rectangle it holds, when there is just one
    gl::Texture2D overlay_;
    gl::Framebuffer overlay_framebuffer_;
    gl::Texture2D picture_;
    gl::Framebuffer picture_framebuffer_;
};

}  // namespace decalgl

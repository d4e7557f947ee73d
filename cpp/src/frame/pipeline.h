// The pipeline: one scene's objects in one GL context, and the passes that make a picture of them.
//
//     for each rectangle:  G-buffer ─▶ overlay, one pass a technique ─▶ compose ─▶ read back
//
// A picture larger than a rectangle is drawn piece by piece with the projection and the levels of detail of
// the whole, so the pieces fit without a seam. pipeline.cpp sets up and reads back, picture_passes.cpp draws.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "decalgl/frame/picture_request.h"
#include "decalgl/frame/renderer.h"
#include "frame/lens_mask.h"
#include "frame/prepared_scene.h"
#include "frame/silhouettes.h"
#include "frame/targets.h"
#include "frame/terrain_mesh.h"
#include "gl/context.h"

namespace decalgl {

class Pipeline {
public:
    explicit Pipeline(const RendererOptions& options, const MemoryAccount& memory);

    gl::Context& context() { return *context_; }

    // Uploads what is not there yet and sets the view up. What was drawn stays where scene and view still show
    // it: nothing is done twice. Throws Error(memory) where the picture is larger than the driver can draw or the
    // budget holds.
    UpdateReport update(std::shared_ptr<const PreparedScene> scene, const PictureRequest& request);
    // The next update and picture begin anew, for those who time them, the ground's too if asked for. What is uploaded
    // stays.
    void forget(bool ground);

    // Everything below draws what update() was last given; arrays have row 0 at the top. The image is that of the
    // last call where nothing has changed since.
    std::shared_ptr<const std::vector<uint8_t>> image(const Background& background);
    // Of each pass from bottom to top: 1 + id at each pixel's centre, 0 where there is none.
    std::vector<std::vector<uint32_t>> draw_ids();
    void draw_surface(std::vector<double>& world, std::vector<float>& depth, std::vector<float>& gradients);
    // Milliseconds that the floor pass takes, for benchmarks.
    double time_floor();
    // Samples that the layers write in one more drawing.
    uint64_t count_fragments();

    bool draws(const PreparedScene* scene, const PictureRequest& request) const;
    // Since the last update, or since an image that was there already was asked for.
    const TimingLog& timings() const { return timings_; }
    const gl::Uploads& uploads() const { return context_->uploads(); }
    std::vector<std::string> variants() const { return programs_.variants(); }
    // How far vertices may have moved, or positions may be off, in pixels in the middle of the last picture; 0 where no
    // layer is in view or the sky is seen there.
    double quantum_pixels() const { return quantum_pixels_; }
    uint64_t triangles() const { return triangles_; }
    // Of the last picture: pixels that were drawn anew since more than one surface is seen in them.
    uint64_t silhouette_pixels() const { return silhouette_pixels_; }
    // Of the techniques' last update.
    const std::vector<std::pair<std::string, double>>& counts() const { return report_.counts; }

private:
    // A rectangle of the picture. What is drawn reaches beyond what is shown where passes look at neighbours.
    struct Piece {
        Rectangle shown;
        Rectangle drawn;
    };
    // What draws a pass of the scene, and what it was given to draw: nothing before the pass shows anything.
    struct Drawer {
        std::unique_ptr<Technique> technique;
        std::shared_ptr<const Prepared> prepared;
        std::shared_ptr<const Prepared> in_lens;
        bool is_updated = false;  // to what it was given, and to the view
        UpdateReport report;
    };

    void upload(std::shared_ptr<const PreparedScene> scene);
    void upload_layers(const PreparedScene& scene);
    void forget_costs();
    void set_view();
    bool is_in_view(const MapReach& reach) const;
    void choose_shown();
    bool shows_layers() const { return !shown_.empty(); }
    // Calls action(place, technique) for the passes in which anything is to be seen, from bottom to top.
    template <typename Action>
    void for_each_shown(Action action) {
        for (const size_t i : shown_)
            action(i, *drawers_[i].technique);
    }
    void draw_image(std::vector<uint8_t>& image);
    double quantum_in_view() const;
    void measure_quantum(const Piece& piece);
    void write_view_block();
    bool has_lens() const;
    GBufferView look_through_lens(const SeenTargets& seen);
    void choose_pieces();
    void make_targets();
    int multisamples() const;
    template <typename T>
    void read_shown(const gl::Framebuffer& framebuffer, GLenum attachment, GLenum format, const Piece& piece,
                    std::vector<T>& picture) const;

    void draw_picture(const Piece& piece);
    void set_sample(const Piece& piece, glm::vec2 jitter);
    void draw_centres(const Piece& piece);
    void draw_terrain(const Piece& piece, gl::Flags flags);
    void draw_overlay(const SeenTargets& seen, Antialias antialias);
    void compose(const SeenTargets& seen, const gl::Framebuffer& target, gl::Flags flags);
    void draw_samples(const Piece& piece);
    void draw_multisamples(const Piece& piece);
    void take_sample(int index);
    void add_sample();
    void show_mean(int samples);
    void redraw_silhouettes(const Piece& piece, std::vector<uint8_t>& image);
    SlopeUse slope_use();  // the most of all layers shown
    void follow_rays(const Piece& piece, const gl::Flags& flags);
    void follow_few_rays(const Piece& piece);
    void follow_all_rays(const Piece& piece);
    std::vector<uint8_t> draw_gathered(const Piece& piece, Span<const uint32_t> pixels);
    void smooth_edges(const Piece& piece);
    void draw_full_screen();

    MemoryAccount memory_;
    struct Recycled {
        void operator()(gl::Context* context) const noexcept {
            gl::Context::recycle(std::unique_ptr<gl::Context>(context));
        }
    };
    std::unique_ptr<gl::Context, Recycled> context_;
    gl::ProgramLibrary programs_;
    RendererOptions options_;
    TimingLog timings_{true};

    std::shared_ptr<const PreparedScene> scene_;
    std::unique_ptr<TerrainMesh> terrain_;
    std::vector<Drawer> drawers_;  // one a pass
    std::vector<size_t> shown_;    // the passes that show anything in this view, from bottom to top

    PictureRequest request_;
    bool is_updated_ = false;  // to scene_ and request_
    UpdateReport report_;
    Background background_;
    std::shared_ptr<const std::vector<uint8_t>> image_;  // null: to be drawn
    MemoryCharge image_charge_;
    View view_;
    ViewBlock view_block_{};
    gl::Buffer view_buffer_;
    gl::VertexArray no_vertices_;
    std::vector<VisibleTile> tiles_;
    std::vector<Piece> pieces_;
    uint64_t triangles_ = 0;
    uint64_t silhouette_pixels_ = 0;
    double quantum_pixels_ = 0.0;

    LensMask lens_mask_;
    LensMask gathered_lens_mask_;
    std::unique_ptr<Targets> targets_;
    std::unique_ptr<Silhouettes> silhouettes_;  // with coverage
    const Piece* at_centres_ = nullptr;         // the piece whose pixel centres the G-buffer holds, if any
};

}  // namespace decalgl

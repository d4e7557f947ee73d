#include "frame/pipeline.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "decalgl/core/error.h"
#include "frame/surface_readback.h"
#include "gl/pass_timer.h"
#include "gl/readback.h"

namespace decalgl {
namespace {

constexpr int largest_rectangle = 4096;

// Mesa's software rasteriser ends the loops of one shader run after 65,535 turns in all.
constexpr uint64_t software_shader_steps = 65535;

gl::Backend backend_named(const std::string& name) {
    if (name == "auto")
        return gl::Backend::automatic;
    if (name == "egl")
        return gl::Backend::egl;
    if (name == "osmesa")
        return gl::Backend::osmesa;
    throw Error(ErrorKind::input, "there is no backend '" + name + "'; choose auto, egl or osmesa");
}

bool same_view(const PictureRequest& a, const PictureRequest& b) {
    return a.camera.eye == b.camera.eye && a.camera.target == b.camera.target && a.camera.up == b.camera.up &&
           a.camera.fov == b.camera.fov && a.camera.view_height == b.camera.view_height &&
           a.width == b.width && a.height == b.height && a.terrain_error == b.terrain_error;
}

// Whether any layer is seen: else there is no overlay, and no texture for one.
bool has_overlay(const PreparedScene& scene) {
    return std::any_of(scene.passes.begin(), scene.passes.end(),
                       [](const PreparedPass& pass) { return pass.shows_anything(); });
}

// Copies a rectangle, whose rows come bottom first, into an array of the whole picture with row 0 at the top.
template <typename T>
void place(const std::vector<T>& pixels, const Rectangle& rectangle, int components, int width, int height,
           std::vector<T>& picture) {
    const auto row_length = static_cast<std::ptrdiff_t>(rectangle.width) * components;
    for (int row = 0; row < rectangle.height; ++row) {
        const int picture_row = height - 1 - (rectangle.y + row);
        const auto target = (static_cast<std::ptrdiff_t>(picture_row) * width + rectangle.x) * components;
        std::copy_n(pixels.begin() + row * row_length, row_length, picture.begin() + target);
    }
}

}  // namespace

Pipeline::Pipeline(const RendererOptions& options, const MemoryAccount& memory)
    : memory_(memory), context_(gl::Context::create(backend_named(options.backend))), options_(options) {
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glDepthFunc(GL_GREATER);
    glDisable(GL_DITHER);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    view_buffer_ =
        gl::Buffer::create(memory_, "frame: view", sizeof(ViewBlock), nullptr, GL_DYNAMIC_STORAGE_BIT);
    no_vertices_ = gl::VertexArray::create();
}

bool Pipeline::draws(const PreparedScene* scene, const PictureRequest& request) const {
    return scene_.get() == scene && same_view(request_, request) && request_.antialias == request.antialias &&
           request_.background.low == request.background.low &&
           request_.background.high == request.background.high;
}

void Pipeline::upload(std::shared_ptr<const PreparedScene> scene) {
    const auto techniques_of = [](const PreparedScene& of) {
        std::vector<std::string> names;
        for (const PreparedPass& pass : of.passes)
            names.push_back(pass.technique);
        return names;
    };
    const bool is_change =
        scene_ && scene_->shares_ground(*scene) && techniques_of(*scene_) == techniques_of(*scene);
    try {
        if (!is_change) {
            // The old scene goes first: both at once may not fit.
            techniques_.clear();
            terrain_.reset();
            scene_.reset();
            terrain_ = std::make_unique<TerrainMesh>(*scene, memory_);
            for (const PreparedPass& pass : scene->passes)
                techniques_.push_back(make_technique(pass.technique));
        }
        for (size_t i = 0; i < techniques_.size(); ++i)
            techniques_[i]->upload(scene->passes[i].prepared, scene->passes[i].in_lens, memory_);
        gl::check_errors("uploading the scene");
    } catch (...) {
        scene_.reset();
        throw;
    }
    scene_ = std::move(scene);
}

UpdateReport Pipeline::update(std::shared_ptr<const PreparedScene> scene, const PictureRequest& request) {
    drawn_in_gbuffer_ = nullptr;
    return update_layers(std::move(scene), request);
}

UpdateReport Pipeline::update_layers(std::shared_ptr<const PreparedScene> scene,
                                     const PictureRequest& request) {
    timings_.clear();
    const bool shows_surface = drawn_in_gbuffer_ != nullptr && scene_ && scene_->shares_ground(*scene) &&
                               same_view(request_, request) &&
                               static_cast<bool>(overlay_) == has_overlay(*scene);
    if (!shows_surface)
        drawn_in_gbuffer_ = nullptr;
    if (scene_ != scene) {
        const gl::PassTimer timer(&timings_, "upload");
        upload(std::move(scene));
    }
    request_ = request;
    if (!shows_surface)
        set_view();
    view_.antialias = request.antialias;
    UpdateReport report;
    report.shader_steps = context_->info().software ? software_shader_steps : 0;
    for (const auto& technique : techniques_) {
        const UpdateReport part = technique->update(view_);
        report.pieces += part.pieces;
        report.bytes += part.bytes;
        report.longest_walk = std::max(report.longest_walk, part.longest_walk);
    }
    return report;
}

void Pipeline::set_view() {
    const PictureRequest& request = request_;
    tiles_ = select_tiles(scene_->tiles, scene_->terrain, request.camera, request.width, request.height,
                          request.terrain_error);
    view_ = {request.width, request.height, scene_->positions, request.antialias,
             widest_pixel(tiles_, scene_->terrain, request.camera, request.height)};
    view_block_ = make_view_block(request.camera, request.width, request.height, scene_->terrain,
                                  scene_->positions, nearest_depth(tiles_, scene_->terrain, request.camera));
    choose_rectangles();
    make_targets();
}

void Pipeline::choose_rectangles() {
    const gl::ContextInfo& limits = context_->info();
    if (request_.width > limits.max_viewport[0] || request_.height > limits.max_viewport[1])
        throw Error(ErrorKind::memory,
                    "a picture of " + std::to_string(request_.width) + " x " +
                        std::to_string(request_.height) + " pixels is larger than this driver's " +
                        std::to_string(limits.max_viewport[0]) + " x " +
                        std::to_string(limits.max_viewport[1]) + "; ask for a smaller size");
    const int wanted = options_.rectangle > 0 ? options_.rectangle : largest_rectangle;
    const int side = std::min(wanted, limits.max_texture_size);
    rectangles_.clear();
    for (int y = 0; y < request_.height; y += side)
        for (int x = 0; x < request_.width; x += side)
            rectangles_.push_back(
                {x, y, std::min(side, request_.width - x), std::min(side, request_.height - y)});
}

void Pipeline::make_targets() {
    const int width = rectangles_.front().width;
    const int height = rectangles_.front().height;
    const bool is_laid_over = has_overlay(*scene_);
    const bool fits = picture_ && gbuffer_.width() == width && gbuffer_.height() == height &&
                      static_cast<bool>(overlay_) == is_laid_over;
    if (fits)
        return;
    gbuffer_ = GBuffer();
    overlay_ = gl::Texture2D();
    picture_ = gl::Texture2D();
    gbuffer_ = GBuffer(width, height, memory_);
    if (is_laid_over) {
        overlay_ = gl::Texture2D::create(memory_, "frame: overlay", GL_RGBA8, width, height);
        overlay_framebuffer_ = gl::Framebuffer::create("overlay", {{GL_COLOR_ATTACHMENT0, &overlay_}});
    }
    picture_ = gl::Texture2D::create(memory_, "frame: picture", GL_RGBA8, width, height);
    picture_framebuffer_ = gl::Framebuffer::create("picture", {{GL_COLOR_ATTACHMENT0, &picture_}});
}

// Runs `body` on each rectangle with its G-buffer drawn; one that is still there is not drawn again.
void Pipeline::for_each_rectangle(const RectangleFn& body) {
    for (const Rectangle& rectangle : rectangles_) {
        if (drawn_in_gbuffer_ != &rectangle) {
            drawn_in_gbuffer_ = nullptr;
            draw_gbuffer(rectangle);
            drawn_in_gbuffer_ = &rectangle;
        }
        body(rectangle);
    }
}

void Pipeline::draw_gbuffer(const Rectangle& rectangle) {
    const gl::PassTimer timer(&timings_, "terrain");
    view_block_.picture.x = rectangle.x;
    view_block_.picture.y = rectangle.y;
    view_buffer_.update(0, sizeof(ViewBlock), &view_block_);
    view_buffer_.bind_base(GL_UNIFORM_BUFFER, 0);
    gbuffer_.begin();
    glViewport(-rectangle.x, -rectangle.y, request_.width, request_.height);
    glEnable(GL_DEPTH_TEST);
    triangles_ = terrain_->draw(tiles_, programs_);
    glDisable(GL_DEPTH_TEST);
}

bool Pipeline::has_lens() const {
    return scene_->lens && has_overlay(*scene_);
}

// The G-buffer with the mask of the lens, drawn for the rectangle that it holds.
GBufferView Pipeline::look_through_lens() {
    GBufferView view = gbuffer_.view();
    if (!has_lens())
        return view;
    const gl::PassTimer timer(&timings_, "lens");
    lens_mask_.draw(scene_->lens, request_, scene_->positions, gbuffer_, programs_, memory_);
    view.lens = &lens_mask_.texture();
    return view;
}

void Pipeline::draw_overlay() {
    const GBufferView view = look_through_lens();
    for (size_t i = 0; i < techniques_.size(); ++i) {
        if (!scene_->passes[i].shows_anything())
            continue;
        const gl::PassTimer timer(&timings_, techniques_[i]->name());
        overlay_framebuffer_.bind();
        techniques_[i]->draw(view_, view, programs_);
    }
}

void Pipeline::compose() {
    const gl::PassTimer timer(&timings_, "compose");
    gl::Program& program = programs_.get("compose", overlay_ ? gl::Flags{"OVERLAY"} : gl::Flags{});
    picture_framebuffer_.bind();
    program.use();
    program.set("surface_texture", 1);
    gbuffer_.surface.bind(1);
    program.set("base_texture", 2);
    gbuffer_.base.bind(2);
    if (overlay_) {
        program.set("overlay_texture", 3);
        overlay_.bind(3);
        program.set("layer_shading", static_cast<float>(scene_->relief.on_layers));
    }
    const auto color = [](const std::array<float, 4>& c) { return glm::vec4(c[0], c[1], c[2], c[3]); };
    program.set("sky_low", color(request_.background.low));
    program.set("sky_high", color(request_.background.high));
    no_vertices_.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

std::vector<uint8_t> Pipeline::draw_image() {
    const size_t bytes = 4 * static_cast<size_t>(request_.width) * static_cast<size_t>(request_.height);
    const MemoryCharge charge(memory_, "frame: image", bytes);
    std::vector<uint8_t> image(bytes);
    for_each_rectangle([&](const Rectangle& rectangle) {
        draw_overlay();
        compose();
        const gl::PassTimer timer(&timings_, "readback");
        place(gl::read_pixels<uint8_t>(picture_framebuffer_, GL_COLOR_ATTACHMENT0, 0, 0, rectangle.width,
                                       rectangle.height, gl::transfer_format(GL_RGBA8), 4),
              rectangle, 4, request_.width, request_.height, image);
    });
    gl::check_errors("drawing the picture");
    return image;
}

std::vector<std::vector<uint32_t>> Pipeline::draw_ids() {
    const size_t pixels = static_cast<size_t>(request_.width) * static_cast<size_t>(request_.height);
    std::vector<std::vector<uint32_t>> ids(techniques_.size(), std::vector<uint32_t>(pixels, 0));
    if (!overlay_)
        return ids;
    const gl::Texture2D target =
        gl::Texture2D::create(memory_, "frame: ids", GL_R32UI, gbuffer_.width(), gbuffer_.height());
    const gl::Framebuffer framebuffer = gl::Framebuffer::create("ids", {{GL_COLOR_ATTACHMENT0, &target}});
    for_each_rectangle([&](const Rectangle& rectangle) {
        const GBufferView view = look_through_lens();
        for (size_t i = 0; i < techniques_.size(); ++i) {
            if (!scene_->passes[i].shows_anything())
                continue;
            framebuffer.bind();
            techniques_[i]->draw_ids(view_, view, programs_);
            place(gl::read_pixels<uint32_t>(framebuffer, GL_COLOR_ATTACHMENT0, 0, 0, rectangle.width,
                                            rectangle.height, gl::transfer_format(GL_R32UI), 1),
                  rectangle, 1, request_.width, request_.height, ids[i]);
        }
    });
    gl::check_errors("drawing ids");
    return ids;
}

void Pipeline::draw_surface(std::vector<double>& world, std::vector<float>& depth) {
    const size_t pixels = static_cast<size_t>(request_.width) * static_cast<size_t>(request_.height);
    std::vector<uint32_t> positions(4 * pixels);
    std::vector<float> surfaces(4 * pixels);
    for_each_rectangle([&](const Rectangle& rectangle) {
        place(gl::read_pixels<uint32_t>(gbuffer_.framebuffer, GL_COLOR_ATTACHMENT0, 0, 0, rectangle.width,
                                        rectangle.height, gl::transfer_format(GL_RGBA32UI), 4),
              rectangle, 4, request_.width, request_.height, positions);
        place(gl::read_pixels<float>(gbuffer_.framebuffer, GL_COLOR_ATTACHMENT1, 0, 0, rectangle.width,
                                     rectangle.height, gl::transfer_format(GL_RGBA32F), 4),
              rectangle, 4, request_.width, request_.height, surfaces);
    });
    gl::check_errors("reading the surface");
    unpack_surface(positions, surfaces, request_, scene_->positions, view_block_.forward.w, world, depth);
}

double Pipeline::time_floor() {
    gl::Program& program = programs_.get("floor");
    TimingLog log(true);
    for_each_rectangle([&](const Rectangle&) {
        const gl::PassTimer timer(&log, "floor");
        picture_framebuffer_.bind();
        program.use();
        program.set("depth_texture", 0);
        gbuffer_.depth.bind(0);
        no_vertices_.bind();
        glDrawArrays(GL_TRIANGLES, 0, 3);
    });
    return log.total();
}

}  // namespace decalgl

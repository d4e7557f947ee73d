#include "frame/pipeline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>
#include <utility>

#include "decalgl/core/error.h"
#include "frame/surface_readback.h"
#include "gl/pass_timer.h"
#include "gl/readback.h"
#include "gl/sample_query.h"

namespace decalgl {
namespace {

constexpr int largest_rectangle = 4096;
constexpr int largest_multisampled = 2048;  // a pixel takes several times the memory

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

// How far passes look beyond a pixel: at the planes of its neighbours, along an edge.
int border_of(Antialias antialias) {
    constexpr int fxaa_reach = 17;  // search_steps and one across, in shaders/compose/fxaa.frag.glsl
    return antialias == Antialias::fxaa ? fxaa_reach : antialias == Antialias::coverage ? 1 : 0;
}

}  // namespace

Pipeline::Pipeline(const RendererOptions& options, const MemoryAccount& memory)
    : memory_(memory),
      context_(gl::Context::acquire(backend_named(options.backend)).release()),
      options_(options) {
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
    return is_updated_ && scene_.get() == scene && same_view(request_, request) &&
           request_.antialias == request.antialias;
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
            at_centres_ = nullptr;
            drawers_.clear();
            terrain_.reset();
            targets_.reset();
            scene_.reset();
            terrain_ = std::make_unique<TerrainMesh>(*scene, memory_);
            for (const PreparedPass& pass : scene->passes)
                drawers_.push_back({make_technique(pass.technique), nullptr, nullptr, false, {}});
        }
        upload_layers(*scene);
        gl::check_errors("uploading the scene");
    } catch (...) {
        scene_.reset();
        throw;
    }
    scene_ = std::move(scene);
}

// What was uploaded of a layer stays while it is hidden, for when it is shown again.
void Pipeline::upload_layers(const PreparedScene& scene) {
    for (size_t i = 0; i < drawers_.size(); ++i) {
        const PreparedPass& pass = scene.passes[i];
        Drawer& drawer = drawers_[i];
        const bool is_there = drawer.prepared == pass.prepared && drawer.in_lens == pass.in_lens;
        if (is_there || !pass.shows_anything())
            continue;
        const bool was_updated = drawer.is_updated;
        drawer.prepared = nullptr;
        drawer.is_updated = false;
        drawer.technique->upload(pass.prepared, pass.in_lens, {&terrain_->heights(), &scene.terrain},
                                 memory_);
        drawer.is_updated = was_updated && drawer.technique->keeps_update();
        drawer.prepared = pass.prepared;
        drawer.in_lens = pass.in_lens;
    }
}

void Pipeline::forget(bool ground) {
    is_updated_ = false;
    if (ground)
        at_centres_ = nullptr;  // so that the view is set anew
    for (Drawer& drawer : drawers_) {
        drawer.technique->forget_view();
        drawer.is_updated = false;
    }
}

void Pipeline::forget_costs() {
    timings_.clear();
    context_->uploads() = {};
}

UpdateReport Pipeline::update(std::shared_ptr<const PreparedScene> scene, const PictureRequest& request) {
    forget_costs();
    if (draws(scene.get(), request))
        return report_;
    is_updated_ = false;
    image_.reset();
    image_charge_ = MemoryCharge();
    if (scene_ != scene) {
        const gl::PassTimer timer(&timings_, "upload");
        upload(std::move(scene));
    }
    if (!same_view(request_, request) || request_.antialias != request.antialias)
        at_centres_ = nullptr;
    request_ = request;
    if (at_centres_ == nullptr)
        set_view();
    choose_shown();
    make_targets();
    UpdateReport report;
    report.shader_steps = context_->info().software ? software_shader_steps : 0;
    for_each_shown([&](size_t i, Technique& technique) {
        if (!drawers_[i].is_updated)
            drawers_[i].report = technique.update(view_);
        drawers_[i].is_updated = true;
        const UpdateReport& part = drawers_[i].report;
        report.counts.insert(report.counts.end(), part.counts.begin(), part.counts.end());
        report.pieces += part.pieces;
        report.bytes += part.bytes;
        report.longest_walk = std::max(report.longest_walk, part.longest_walk);
    });
    report_ = report;
    is_updated_ = true;
    return report;
}

void Pipeline::set_view() {
    const PictureRequest& request = request_;
    for (Drawer& drawer : drawers_)
        drawer.is_updated = false;
    tiles_ = select_tiles(scene_->tiles, scene_->terrain, request.camera, request.width, request.height,
                          request.terrain_error);
    const double nearest = nearest_depth(tiles_, scene_->terrain, request.camera);
    view_ = {request.width,
             request.height,
             scene_->positions,
             request.antialias == Antialias::coverage ? Antialias::coverage : Antialias::none,
             widest_pixel(tiles_, scene_->terrain, request.camera, request.height),
             pixel_at(request.camera, request.height, nearest),
             request.terrain_error,
             options_.coverage,
             &view_block_,
             &timings_,
             false};
    view_block_ = make_view_block(request.camera, request.width, request.height, scene_->terrain,
                                  scene_->positions, nearest);
    write_view_block();
    if (request.antialias == Antialias::coverage && !tiles_.empty())  // for the rays of silhouettes
        terrain_->set_levels(tiles_);
    choose_pieces();
}

bool Pipeline::is_in_view(const MapReach& reach) const {
    return std::any_of(tiles_.begin(), tiles_.end(), [&](const VisibleTile& visible) {
        return reach.meets(bounds_of(*visible.tile, scene_->terrain));
    });
}

void Pipeline::choose_shown() {
    shown_.clear();
    for (size_t i = 0; i < drawers_.size(); ++i)
        if (scene_->passes[i].shows_anything() && is_in_view(scene_->passes[i].reach))
            shown_.push_back(i);
}

void Pipeline::choose_pieces() {
    const gl::ContextInfo& limits = context_->info();
    if (request_.width > limits.max_viewport[0] || request_.height > limits.max_viewport[1])
        throw Error(ErrorKind::memory,
                    "a picture of " + std::to_string(request_.width) + " x " +
                        std::to_string(request_.height) + " pixels is larger than this driver's " +
                        std::to_string(limits.max_viewport[0]) + " x " +
                        std::to_string(limits.max_viewport[1]) + "; ask for a smaller size");
    const int border = border_of(request_.antialias);
    const int largest = request_.antialias == Antialias::msaa ? largest_multisampled : largest_rectangle;
    const int wanted = options_.rectangle > 0 ? options_.rectangle : largest;
    const int side = std::min(wanted, limits.max_texture_size - 2 * border);
    pieces_.clear();
    for (int y = 0; y < request_.height; y += side) {
        for (int x = 0; x < request_.width; x += side) {
            const int right = std::min(x + side, request_.width);
            const int top = std::min(y + side, request_.height);
            const int left = std::max(0, x - border);
            const int bottom = std::max(0, y - border);
            pieces_.push_back({{x, y, right - x, top - y},
                               {left, bottom, std::min(right + border, request_.width) - left,
                                std::min(top + border, request_.height) - bottom}});
        }
    }
}

// The most samples a pixel that the driver draws at once and that divide those asked for; 0 where it has none.
int Pipeline::multisamples() const {
    std::set<GLint> counts;
    for (int count = 2; count <= options_.samples; count *= 2)
        counts.insert(count);
    for (const GLenum format : {GL_RGBA32UI, GL_RGBA32F, GL_RGBA8, GL_DEPTH_COMPONENT32F}) {
        std::array<GLint, 16> supported{};
        glGetInternalformativ(GL_TEXTURE_2D_MULTISAMPLE, format, GL_SAMPLES, supported.size(),
                              supported.data());
        for (auto count = counts.begin(); count != counts.end();)
            count = std::count(supported.begin(), supported.end(), *count) > 0 ? std::next(count)
                                                                               : counts.erase(count);
    }
    return counts.empty() ? 0 : *counts.rbegin();
}

void Pipeline::make_targets() {
    TargetNeeds needs;
    for (const Piece& piece : pieces_) {
        needs.width = std::max(needs.width, piece.drawn.width);
        needs.height = std::max(needs.height, piece.drawn.height);
    }
    needs.antialias = request_.antialias;
    needs.multisamples = request_.antialias == Antialias::msaa ? multisamples() : 0;
    needs.has_overlay = shows_layers();
    for_each_shown([&](size_t, const Technique& technique) {
        if (technique.needs_depth(view_))
            needs.overlay_depth = std::max(needs.overlay_depth, OverlayDepth::depth);
        if (technique.needs_stencil(view_))
            needs.overlay_depth = OverlayDepth::depth_and_stencil;
    });
    // An overlay stays for when layers are seen again.
    if (targets_ && targets_->needs.serve(needs))
        return;
    at_centres_ = nullptr;
    targets_.reset();  // both at once may not fit
    silhouettes_.reset();
    targets_ = std::make_unique<Targets>(needs, memory_);
    if (needs.antialias == Antialias::coverage)
        silhouettes_ = std::make_unique<Silhouettes>(needs.width, needs.height, needs.has_overlay, memory_);
}

// Copies what is shown of a piece into an array of the whole picture, with row 0 at the top.
template <typename T>
void Pipeline::read_shown(const gl::Framebuffer& framebuffer, GLenum attachment, GLenum format,
                          const Piece& piece, std::vector<T>& picture) const {
    const auto components = static_cast<int>(gl::texel_bytes(format) / sizeof(T));
    const std::vector<T> pixels = gl::read_pixels<T>(
        framebuffer, attachment, piece.shown.x - piece.drawn.x, piece.shown.y - piece.drawn.y,
        piece.shown.width, piece.shown.height, gl::transfer_format(format), components);
    const auto row_length = static_cast<std::ptrdiff_t>(piece.shown.width) * components;
    for (int row = 0; row < piece.shown.height; ++row) {
        const int picture_row = request_.height - 1 - (piece.shown.y + row);
        const auto target =
            (static_cast<std::ptrdiff_t>(picture_row) * request_.width + piece.shown.x) * components;
        std::copy_n(pixels.begin() + row * row_length, row_length, picture.begin() + target);
    }
}

bool Pipeline::has_lens() const {
    return scene_->lens && shows_layers();
}

// The G-buffer with the mask of the lens, drawn for the piece that it holds.
GBufferView Pipeline::look_through_lens(const SeenTargets& seen) {
    GBufferView view = seen.gbuffer.view();
    const bool is_gathered = &seen != &targets_->seen;
    if (is_gathered)
        view.set_gathered = [this](gl::Program& program) { silhouettes_->set_gathered(program); };
    if (!has_lens())
        return view;
    const gl::PassTimer timer(&timings_, "lens");
    LensMask& mask = is_gathered ? gathered_lens_mask_ : lens_mask_;
    mask.draw(scene_->lens, request_, scene_->positions, seen.gbuffer,
              is_gathered ? silhouettes_.get() : nullptr, programs_, memory_);
    view.lens = &mask.texture();
    return view;
}

std::shared_ptr<const std::vector<uint8_t>> Pipeline::image(const Background& background) {
    if (image_ && background_ == background) {
        forget_costs();
        return image_;
    }
    background_ = background;
    image_.reset();
    image_charge_ = MemoryCharge();
    const size_t bytes = 4 * static_cast<size_t>(request_.width) * static_cast<size_t>(request_.height);
    image_charge_ = MemoryCharge(memory_, "frame: image", bytes);
    auto image = std::make_shared<std::vector<uint8_t>>(bytes);
    draw_image(*image);
    image_ = image;
    return image;
}

void Pipeline::draw_image(std::vector<uint8_t>& image) {
    silhouette_pixels_ = 0;
    quantum_pixels_ = 0.0;
    for (const Piece& piece : pieces_) {
        draw_picture(piece);
        {
            const gl::PassTimer timer(&timings_, "readback");
            read_shown(targets_->picture_framebuffer, GL_COLOR_ATTACHMENT0, GL_RGBA8, piece, image);
            measure_quantum(piece);
        }
        if (silhouettes_ && !tiles_.empty())
            redraw_silhouettes(piece, image);
    }
    gl::check_errors("drawing the picture");
}

// Of layers that are seen, or would be had they not been rounded to nothing; 0 where there are none.
double Pipeline::quantum_in_view() const {
    double quantum = 0.0;
    for (const PreparedPass& pass : scene_->passes) {
        const PreparedCounts counts = pass.prepared->counts();
        if ((pass.shows_anything() || counts.pieces == 0) && is_in_view(pass.reach))
            quantum = std::max(quantum, counts.quantum);
    }
    // Positions are offsets in blocks, in float32.
    return quantum > 0.0 ? std::max(quantum, std::ldexp(scene_->positions.block_size, -23)) : 0.0;
}

void Pipeline::measure_quantum(const Piece& piece) {
    const int x = request_.width / 2 - piece.shown.x, y = request_.height / 2 - piece.shown.y;
    const double quantum = quantum_in_view();
    if (quantum == 0.0 || x < 0 || y < 0 || x >= piece.shown.width || y >= piece.shown.height)
        return;
    const std::vector<float> middle = gl::read_pixels<float>(
        targets_->seen.gbuffer.framebuffer, GL_COLOR_ATTACHMENT1, x + piece.shown.x - piece.drawn.x,
        y + piece.shown.y - piece.drawn.y, 1, 1, gl::transfer_format(GL_RGBA32F), 4);
    const double depth = view_block_.forward.w + static_cast<double>(middle[2]);
    const double pixel = pixel_at(request_.camera, request_.height, depth);
    if (std::isfinite(depth) && pixel > 0.0)
        quantum_pixels_ = quantum / pixel;
}

std::vector<std::vector<uint32_t>> Pipeline::draw_ids() {
    const size_t pixels = static_cast<size_t>(request_.width) * static_cast<size_t>(request_.height);
    std::vector<std::vector<uint32_t>> ids(drawers_.size(), std::vector<uint32_t>(pixels, 0));
    if (!shows_layers())
        return ids;
    const gl::Texture2D target =
        gl::Texture2D::create(memory_, "frame: ids", GL_R32UI, targets_->needs.width, targets_->needs.height);
    std::vector<gl::Attachment> attachments{{GL_COLOR_ATTACHMENT0, &target}};
    if (targets_->needs.overlay_depth == OverlayDepth::depth_and_stencil)
        attachments.push_back({GL_DEPTH_STENCIL_ATTACHMENT, &targets_->seen.overlay_depth});
    const gl::Framebuffer framebuffer = gl::Framebuffer::create("ids", attachments);
    for (const Piece& piece : pieces_) {
        draw_centres(piece);
        const GBufferView view = look_through_lens(targets_->seen);
        for_each_shown([&](size_t i, Technique& technique) {
            framebuffer.bind();
            technique.draw_ids(view_, view, programs_);
            read_shown(framebuffer, GL_COLOR_ATTACHMENT0, GL_R32UI, piece, ids[i]);
        });
    }
    gl::check_errors("drawing ids");
    return ids;
}

void Pipeline::draw_surface(std::vector<double>& world, std::vector<float>& depth,
                            std::vector<float>& gradients) {
    const size_t pixels = static_cast<size_t>(request_.width) * static_cast<size_t>(request_.height);
    std::vector<uint32_t> positions(4 * pixels);
    std::vector<float> surfaces(4 * pixels);
    for (const Piece& piece : pieces_) {
        draw_centres(piece);
        const gl::Framebuffer& framebuffer = targets_->seen.gbuffer.framebuffer;
        read_shown(framebuffer, GL_COLOR_ATTACHMENT0, GL_RGBA32UI, piece, positions);
        read_shown(framebuffer, GL_COLOR_ATTACHMENT1, GL_RGBA32F, piece, surfaces);
    }
    gl::check_errors("reading the surface");
    unpack_surface(positions, surfaces, request_, scene_->positions, view_block_.forward.w, world, depth,
                   gradients);
}

double Pipeline::time_floor() {
    gl::Program& program = programs_.get("floor");
    TimingLog log(true);
    for (const Piece& piece : pieces_) {
        draw_centres(piece);
        const gl::PassTimer timer(&log, "floor");
        targets_->picture_framebuffer.bind();
        program.use();
        program.set("depth_texture", 0);
        targets_->seen.gbuffer.depth.bind(0);
        draw_full_screen();
    }
    return log.total();
}

uint64_t Pipeline::count_fragments() {
    uint64_t total = 0;
    for (const Piece& piece : pieces_) {
        draw_centres(piece);
        gl::SampleQuery query;
        draw_overlay(targets_->seen, Antialias::none);
        total += query.count();
    }
    return total;
}

}  // namespace decalgl

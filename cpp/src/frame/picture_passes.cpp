// The passes of one piece of the picture, by the way of anti-aliasing.
//
//     none, coverage    G-buffer ─▶ overlay ─▶ compose
//     ssaa              the same for each jittered sample, and the mean of all (Zechmeister 2020, 3.5)
//     msaa              one multisampled G-buffer for as many samples as the driver has; then as ssaa
//     fxaa              compose ─▶ fxaa
//
// With coverage, pixels through which a silhouette passes are drawn once more (silhouettes.h).
#include <algorithm>
#include <limits>

#include "frame/pipeline.h"
#include "frame/sample_pattern.h"
#include "gl/pass_timer.h"

namespace decalgl {
namespace {

// Draws only into the rows below this one.
class LowerRows {
public:
    LowerRows(int width, int rows) {
        glEnable(GL_SCISSOR_TEST);
        glScissor(0, 0, width, rows);
    }
    ~LowerRows() { glDisable(GL_SCISSOR_TEST); }
    LowerRows(const LowerRows&) = delete;
    LowerRows& operator=(const LowerRows&) = delete;
};

// Where the driver's samples lie, in pixels from the centre.
std::vector<glm::vec2> driver_pattern(int count) {
    std::vector<glm::vec2> offsets(static_cast<size_t>(count));
    for (int i = 0; i < count; ++i) {
        float place[2];
        glGetMultisamplefv(GL_SAMPLE_POSITION, static_cast<GLuint>(i), place);
        offsets[static_cast<size_t>(i)] = glm::vec2(place[0], place[1]) - 0.5F;
    }
    return offsets;
}

}  // namespace

void Pipeline::draw_picture(const Piece& piece) {
    switch (request_.antialias) {
        case Antialias::none:
        case Antialias::coverage:
            draw_centres(piece);
            draw_overlay(targets_->seen, request_.antialias);
            compose(targets_->seen, targets_->picture_framebuffer, {});
            break;
        case Antialias::ssaa:
            draw_samples(piece);
            break;
        case Antialias::msaa:
            if (targets_->needs.multisamples > 0)
                draw_multisamples(piece);
            else
                draw_samples(piece);
            break;
        case Antialias::fxaa:
            draw_centres(piece);
            draw_overlay(targets_->seen, Antialias::none);
            compose(targets_->seen, targets_->composed_framebuffer, {});
            smooth_edges(piece);
            break;
    }
}

// From here on, passes see each pixel at a place this far from its centre.
void Pipeline::set_sample(const Piece& piece, glm::vec2 jitter) {
    at_centres_ = nullptr;
    view_block_.picture.x = piece.drawn.x;
    view_block_.picture.y = piece.drawn.y;
    view_block_.jitter = glm::vec4(jitter, 0.0F, 0.0F);
    write_view_block();
}

void Pipeline::write_view_block() {
    view_buffer_.update(0, sizeof(ViewBlock), &view_block_);
    view_buffer_.bind_base(GL_UNIFORM_BUFFER, 0);
}

// The G-buffer of a piece at its pixels' centres; one that is still there is not drawn again.
void Pipeline::draw_centres(const Piece& piece) {
    if (at_centres_ == &piece)
        return;
    set_sample(piece, glm::vec2(0.0F));
    targets_->seen.gbuffer.begin();
    draw_terrain(piece, {});
    at_centres_ = &piece;
}

void Pipeline::draw_terrain(const Piece& piece, gl::Flags flags) {
    triangles_ = 0;
    if (tiles_.empty())
        return;
    const gl::PassTimer timer(&timings_, "terrain");
    glViewport(-piece.drawn.x, -piece.drawn.y, request_.width, request_.height);
    glEnable(GL_DEPTH_TEST);
    triangles_ = terrain_->draw(tiles_, std::move(flags), programs_);
    glDisable(GL_DEPTH_TEST);
}

void Pipeline::draw_overlay(const SeenTargets& seen, Antialias antialias) {
    View view = view_;
    view.antialias = antialias;
    const GBufferView surface = look_through_lens(seen);
    for_each_shown([&](size_t, Technique& technique) {
        const gl::PassTimer timer(&timings_, technique.name());
        seen.overlay_framebuffer.bind();
        technique.draw(view, surface, programs_);
        view.has_below = true;
    });
}

void Pipeline::compose(const SeenTargets& seen, const gl::Framebuffer& target, gl::Flags flags) {
    const gl::PassTimer timer(&timings_, "compose");
    if (shows_layers())
        flags.insert("OVERLAY");
    gl::Program& program = programs_.get("compose", flags);
    target.bind();
    program.use();
    if (flags.count("GATHERED") != 0)
        silhouettes_->set_gathered(program);
    program.set("surface_texture", 1);
    seen.gbuffer.surface.bind(1);
    program.set("base_texture", 2);
    seen.gbuffer.base.bind(2);
    if (shows_layers()) {
        program.set("overlay_texture", 3);
        seen.overlay.bind(3);
        program.set("layer_shading", static_cast<float>(scene_->relief.on_layers));
    }
    const auto color = [](const std::array<float, 4>& c) { return glm::vec4(c[0], c[1], c[2], c[3]); };
    program.set("sky_low", color(background_.low));
    program.set("sky_high", color(background_.high));
    draw_full_screen();
}

void Pipeline::draw_samples(const Piece& piece) {
    targets_->sum_framebuffer.clear_color(0, 0.0F, 0.0F, 0.0F, 0.0F);
    for (const glm::vec2 jitter : sample_pattern(options_.samples)) {
        set_sample(piece, jitter);
        targets_->seen.gbuffer.begin();
        draw_terrain(piece, {});
        add_sample();
    }
    show_mean(options_.samples);
}

// More samples than the driver has are its pattern, moved by a pattern of half a pixel: less leaves the samples in
// heaps, and more spreads them beyond the pixel.
void Pipeline::draw_multisamples(const Piece& piece) {
    const int at_once = targets_->needs.multisamples;
    targets_->sum_framebuffer.clear_color(0, 0.0F, 0.0F, 0.0F, 0.0F);
    for (const glm::vec2 offset : sample_pattern(options_.samples / at_once)) {
        const glm::vec2 jitter = 0.5F * offset;
        set_sample(piece, jitter);
        targets_->multisampled.begin();
        const std::vector<glm::vec2> places = driver_pattern(at_once);
        draw_terrain(piece, {"MULTISAMPLED"});
        for (int i = 0; i < at_once; ++i) {
            set_sample(piece, jitter + places[static_cast<size_t>(i)]);
            take_sample(i);
            add_sample();
        }
    }
    show_mean(options_.samples);
}

void Pipeline::take_sample(int index) {
    const gl::PassTimer timer(&timings_, "one_sample");
    gl::Program& program = programs_.get("one_sample");
    targets_->seen.gbuffer.framebuffer.bind();
    program.use();
    program.set("position_texture", 0);
    targets_->multisampled.position.bind(0);
    program.set("surface_texture", 1);
    targets_->multisampled.surface.bind(1);
    program.set("base_texture", 2);
    targets_->multisampled.base.bind(2);
    program.set("sample_index", index);
    draw_full_screen();
}

// Adds the picture of the sample that the G-buffer holds to the sum.
void Pipeline::add_sample() {
    draw_overlay(targets_->seen, Antialias::none);
    glBlendFunc(GL_ONE, GL_ONE);
    glEnable(GL_BLEND);
    compose(targets_->seen, targets_->sum_framebuffer, {"SAMPLE"});
    glDisable(GL_BLEND);
}

void Pipeline::show_mean(int samples) {
    const gl::PassTimer timer(&timings_, "mean");
    gl::Program& program = programs_.get("mean");
    targets_->picture_framebuffer.bind();
    program.use();
    program.set("sum_texture", 0);
    targets_->sum.bind(0);
    program.set("sample_count", static_cast<float>(samples));
    draw_full_screen();
}

SlopeUse Pipeline::slope_use() {
    SlopeUse most = SlopeUse::none;
    for_each_shown([&](size_t, const Technique& technique) { most = std::max(most, technique.slope_use()); });
    return most;
}

void Pipeline::redraw_silhouettes(const Piece& piece, std::vector<uint8_t>& image) {
    std::vector<uint32_t> pixels;
    {
        const gl::PassTimer timer(&timings_, "silhouettes");
        pixels =
            silhouettes_->find(targets_->seen.gbuffer, shows_layers() ? &targets_->seen.overlay : nullptr,
                               slope_use(), piece.drawn, piece.shown, *terrain_, programs_);
    }
    silhouette_pixels_ += pixels.size();
    for (size_t first = 0; first < pixels.size(); first += Silhouettes::batch_size) {
        const size_t count = std::min(Silhouettes::batch_size, pixels.size() - first);
        const std::vector<uint8_t> means =
            draw_gathered(piece, Span<const uint32_t>(pixels).subspan(first, count));
        for (size_t i = 0; i < count; ++i) {
            const auto x = static_cast<size_t>(piece.drawn.x) + (pixels[first + i] & 0xFFFFU);
            const auto y = static_cast<size_t>(piece.drawn.y) + (pixels[first + i] >> 16U);
            const size_t row = static_cast<size_t>(request_.height) - 1 - y;
            const size_t target = 4 * (row * static_cast<size_t>(request_.width) + x);
            std::copy_n(means.begin() + static_cast<std::ptrdiff_t>(4 * i), 4,
                        image.begin() + static_cast<std::ptrdiff_t>(target));
        }
    }
}

void Pipeline::follow_rays(const Piece& piece, const gl::Flags& flags) {
    gl::Flags all = terrain_->ray_flags();
    all.insert(flags.begin(), flags.end());
    gl::Program& program = programs_.get("gathered", all);
    program.use();
    terrain_->set_for_rays(program);
    program.set("surface_texture", 4);
    targets_->seen.gbuffer.surface.bind(4);
    program.set("drawn_size", glm::ivec2(piece.drawn.width, piece.drawn.height));
    program.set("no_distance", std::numeric_limits<float>::infinity());
    if (flags.count("RAYS") != 0)
        silhouettes_->set_rays(program);
    else
        silhouettes_->set_gathered(program);
    draw_full_screen();
}

// Sixteen rays of each pixel of the batch, and whether they are too few.
void Pipeline::follow_few_rays(const Piece& piece) {
    const gl::PassTimer timer(&timings_, "gathered");
    const LowerRows used(silhouettes_->ray_columns(), silhouettes_->ray_rows());
    silhouettes_->rays().framebuffer.bind();
    follow_rays(piece, {"RAYS"});
    silhouettes_->count_facets(programs_);
}

// A ray for each sample: where what was spread is marked by its depth, or for all.
void Pipeline::follow_all_rays(const Piece& piece) {
    const gl::PassTimer timer(&timings_, "gathered");
    silhouettes_->seen().gbuffer.framebuffer.bind();
    if (slope_use() == SlopeUse::strokes) {
        follow_rays(piece, {});
        return;
    }
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_FALSE);
    glDepthFunc(GL_EQUAL);
    glDepthRange(1.0, 1.0);
    follow_rays(piece, {});
    glDepthRange(0.0, 1.0);
    glDepthFunc(GL_GREATER);
    glDepthMask(GL_TRUE);
    glDisable(GL_DEPTH_TEST);
}

// The colours of some pixels, each the mean of its samples.
std::vector<uint8_t> Pipeline::draw_gathered(const Piece& piece, Span<const uint32_t> pixels) {
    silhouettes_->gather(pixels);
    if (slope_use() != SlopeUse::strokes)
        follow_few_rays(piece);
    const LowerRows used(silhouettes_->sample_columns(), silhouettes_->sample_rows());
    if (slope_use() != SlopeUse::strokes) {
        const gl::PassTimer timer(&timings_, "spread");
        silhouettes_->spread(programs_);
    }
    follow_all_rays(piece);
    const SeenTargets& seen = silhouettes_->seen();
    draw_overlay(seen, Antialias::none);
    compose(seen, silhouettes_->composed(), {"SAMPLE", "GATHERED"});
    const gl::PassTimer timer(&timings_, "readback");
    return silhouettes_->means(programs_);
}

void Pipeline::smooth_edges(const Piece& piece) {
    const gl::PassTimer timer(&timings_, "fxaa");
    gl::Program& program = programs_.get("fxaa");
    targets_->picture_framebuffer.bind();
    program.use();
    program.set("composed_texture", 0);
    targets_->composed.bind(0);
    program.set("drawn_size", glm::ivec2(piece.drawn.width, piece.drawn.height));
    draw_full_screen();
}

void Pipeline::draw_full_screen() {
    no_vertices_.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace decalgl

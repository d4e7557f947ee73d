#include "decalgl/frame/renderer.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "decalgl/core/error.h"
#include "frame/pipeline.h"
#include "frame/prepared_file.h"
#include "frame/sample_pattern.h"
#include "frame/scene_changes.h"
#include "frame/stats.h"
#include "frame/view_setup.h"

namespace decalgl {
namespace {

constexpr int largest_side = 1 << 20;

void require_in_range(const char* name, int value, int least, int most) {
    if (value < least || value > most)
        throw Error(ErrorKind::input, std::string(name) + " must be from " + std::to_string(least) + " to " +
                                          std::to_string(most) + ", but it is " + std::to_string(value));
}

void require_options(const RendererOptions& options) {
    if (options.width < 1 || options.height < 1 || options.width > largest_side ||
        options.height > largest_side)
        throw Error(ErrorKind::input,
                    "the picture's size must be at least 1 x 1 pixels and reasonable, not " +
                        std::to_string(options.width) + " x " + std::to_string(options.height));
    if (!(options.terrain_error >= 0.0))
        throw Error(ErrorKind::input, "terrain_error must be zero or more pixels");
    if (!has_sample_pattern(options.samples))
        throw Error(ErrorKind::input,
                    "samples must be 1, 2, 4, 8, 16 or 32, but it is " + std::to_string(options.samples));
    if (options.rectangle < 0)
        throw Error(ErrorKind::input, "rectangle must be zero or more pixels");
    if (options.index != "grid" && options.index != "bvh")
        throw Error(ErrorKind::input, "there is no index '" + options.index + "'; choose grid or bvh");
    require_in_range("cells", options.bvh.cells, 1, 4096);
    require_in_range("leaf_capacity", options.bvh.leaf_capacity, 1, 1024);
    require_in_range("depth_limit", options.bvh.depth_limit, 0, 16);
}

}  // namespace

struct RendererState {
    RendererOptions options;
    MemoryAccount memory;
    std::mutex scene_mutex;  // preprocess and changes may run on another thread
    std::shared_ptr<const PreparedScene> scene;
    std::unique_ptr<Pipeline> pipeline;  // made by the first update
    PictureRequest request;
    std::shared_ptr<const PreparedScene> updated_scene;  // what the last successful update was given
    double update_ms = 0.0;

    std::shared_ptr<const PreparedScene> latest_scene() {
        const std::lock_guard<std::mutex> lock(scene_mutex);
        return scene;
    }

    std::shared_ptr<const PreparedScene> require_scene(const char* to_do) {
        auto latest = latest_scene();
        if (!latest)
            throw Error(ErrorKind::input,
                        std::string("nothing to ") + to_do + " yet; call preprocess(scene) first");
        return latest;
    }

    Pipeline& updated_pipeline() {
        if (!pipeline)
            throw Error(ErrorKind::input, "no view to draw yet; call update(camera) first");
        return *pipeline;
    }

    void set_scene(std::shared_ptr<const PreparedScene> prepared) {
        const std::lock_guard<std::mutex> lock(scene_mutex);
        scene = std::move(prepared);
    }

    // What the camera was updated to is changed with it, so that the next picture shows the change.
    void change_scene(const std::shared_ptr<const PreparedScene>& before,
                      std::shared_ptr<const PreparedScene> after) {
        const std::lock_guard<std::mutex> lock(scene_mutex);
        if (updated_scene == before)
            updated_scene = after;
        scene = std::move(after);
    }

    void set_updated_scene(std::shared_ptr<const PreparedScene> updated) {
        const std::lock_guard<std::mutex> lock(scene_mutex);
        updated_scene = std::move(updated);
    }

    std::shared_ptr<const PreparedScene> latest_updated_scene() {
        const std::lock_guard<std::mutex> lock(scene_mutex);
        return updated_scene;
    }

    // Makes the pipeline draw a request, whatever it drew last.
    Pipeline& pipeline_for(const std::shared_ptr<const PreparedScene>& wanted,
                           const PictureRequest& wanted_request) {
        if (!pipeline->draws(wanted.get(), wanted_request))
            pipeline->update(wanted, wanted_request);
        return *pipeline;
    }
};

struct FrameState {
    std::shared_ptr<RendererState> renderer;
    std::shared_ptr<const PreparedScene> scene;
    PictureRequest request;
    FrameStats stats;
    std::shared_ptr<const std::vector<uint8_t>> image;
    std::vector<int64_t> ids;
    std::vector<int32_t> layers;
    std::vector<float> depth;
    std::vector<double> world;
    std::vector<float> gradients;  // x, y a pixel

    void read_surface();
    void read_ids();
};

Renderer::Renderer(RendererOptions options) : state_(std::make_shared<RendererState>()) {
    require_options(options);
    state_->options = std::move(options);
    state_->memory = MemoryAccount(state_->options.memory_limit);
}

const RendererOptions& Renderer::options() const {
    return state_->options;
}

void Renderer::set_picture(int width, int height, Antialias antialias) {
    RendererOptions options = state_->options;
    options.width = width;
    options.height = height;
    options.antialias = antialias;
    require_options(options);
    state_->options = options;
}

void Renderer::preprocess(const Scene& scene, const ProgressFn& progress, const std::string& cache) {
    const RendererOptions& options = state_->options;
    if (!cache.empty() && options.index != "grid")
        throw Error(
            ErrorKind::unsupported,
            "index '" + options.index + "' is not kept on disk; leave cache out, or use index 'grid'");
    state_->set_scene(cache.empty() ? prepare_scene(scene, options, state_->memory, progress)
                                    : prepare_cached(scene, cache, options, state_->memory, progress));
}

void Renderer::save(const std::string& path) const {
    save_scene(*state_->require_scene("save"), path, state_->options.threads, {});
}

void Renderer::open(const std::string& path) {
    state_->set_scene(open_scene(path, state_->options.threads, state_->memory));
}

LayerLook Renderer::look(uint32_t layer) const {
    const auto scene = state_->require_scene("look at");
    require_layer(*scene, layer);
    LayerLook look;
    look.layer = layer;
    const size_t features = scene->layers[layer].rows.size();
    for (const PreparedPass& pass : scene->passes) {
        if (!pass.has_layer(layer))
            continue;
        const LayerLook part = pass.prepared->look_of(layer, features);
        for (const DecalRole role : {DecalRole::fill, DecalRole::stroke, DecalRole::casing})
            if (!part.of(role)->colors.empty())
                *look.of(role) = *part.of(role);
    }
    return look;
}

void Renderer::restyle(const std::vector<LayerLook>& looks) {
    const auto before = state_->require_scene("restyle");
    state_->change_scene(before, restyled_scene(*before, looks, state_->memory));
}

void Renderer::edit(const LayerEdit& edit) {
    const auto before = state_->require_scene("edit");
    state_->change_scene(before, edited_scene(*before, edit, state_->memory));
}

void Renderer::set_lens(const Lens& lens, const std::vector<LayerLook>& looks) {
    const auto before = state_->require_scene("look at");
    state_->change_scene(before,
                         scene_with_lens(*before, std::make_shared<const Lens>(lens), looks, state_->memory));
}

void Renderer::move_lens(const Lens& lens) {
    const auto before = state_->require_scene("look at");
    state_->change_scene(before, scene_with_moved_lens(*before, std::make_shared<const Lens>(lens)));
}

void Renderer::remove_lens() {
    const auto before = state_->require_scene("look at");
    state_->change_scene(before, scene_with_lens(*before, nullptr, {}, state_->memory));
}

std::vector<PreparedLayer> Renderer::layers() const {
    return state_->require_scene("describe")->layers;
}

Bounds Renderer::bounds() const {
    return state_->require_scene("describe")->terrain.bounds();
}

UpdateReport Renderer::update(const Camera& camera) {
    RendererState& state = *state_;
    const std::shared_ptr<const PreparedScene> scene = state.require_scene("draw");
    const Stopwatch watch;
    if (!state.pipeline) {
        state.pipeline = std::make_unique<Pipeline>(state.options, state.memory);
        state.pipeline->context().release();  // between calls, any thread may take it
    }
    const gl::CurrentScope current(state.pipeline->context());
    const RendererOptions& options = state.options;
    const PictureRequest request{camera, options.width, options.height, options.antialias,
                                 options.terrain_error};
    const UpdateReport report = state.pipeline->update(scene, request);
    state.request = request;
    state.set_updated_scene(scene);
    state.update_ms = watch.milliseconds();
    return report;
}

Frame Renderer::render(const Background& background) {
    RendererState& state = *state_;
    auto scene = state.latest_updated_scene();
    if (!scene)
        throw Error(ErrorKind::input, "no view to draw yet; call update(camera) first");
    const gl::CurrentScope current(state.pipeline->context());
    auto frame = std::make_shared<FrameState>();
    frame->renderer = state_;
    frame->scene = std::move(scene);
    frame->request = state.request;
    const Stopwatch watch;
    Pipeline& pipeline = state.pipeline_for(frame->scene, frame->request);
    frame->image = pipeline.image(background);
    frame->stats = collect_stats(pipeline, *frame->scene, state.memory);
    frame->stats.update_ms = state.update_ms;
    frame->stats.render_ms = watch.milliseconds() - frame->stats.readback_ms;
    return Frame(std::move(frame));
}

void Renderer::forget(bool ground) {
    if (state_->pipeline)
        state_->pipeline->forget(ground);
}

double Renderer::time_floor() {
    Pipeline& pipeline = state_->updated_pipeline();
    const gl::CurrentScope current(pipeline.context());
    return pipeline.time_floor();
}

uint64_t Renderer::count_fragments() {
    Pipeline& pipeline = state_->updated_pipeline();
    const gl::CurrentScope current(pipeline.context());
    return pipeline.count_fragments();
}

void FrameState::read_surface() {
    if (!depth.empty())
        return;
    const gl::CurrentScope current(renderer->pipeline->context());
    renderer->pipeline_for(scene, request).draw_surface(world, depth, gradients);
}

void FrameState::read_ids() {
    if (!ids.empty())
        return;
    const gl::CurrentScope current(renderer->pipeline->context());
    const std::vector<std::vector<uint32_t>> passes = renderer->pipeline_for(scene, request).draw_ids();
    const size_t pixels = static_cast<size_t>(request.width) * static_cast<size_t>(request.height);
    ids.assign(pixels, -1);
    layers.assign(pixels, -1);
    for (size_t pass = 0; pass < passes.size(); ++pass) {
        const Prepared& prepared = *scene->passes[pass].prepared;
        for (size_t i = 0; i < pixels; ++i) {
            if (passes[pass][i] == 0)
                continue;
            const FeatureReference reference = prepared.feature(passes[pass][i] - 1);
            ids[i] = scene->row_of(reference);
            layers[i] = static_cast<int32_t>(reference.layer);
        }
    }
}

int Frame::width() const {
    return state_->request.width;
}
int Frame::height() const {
    return state_->request.height;
}
const std::vector<uint8_t>& Frame::image() const {
    return *state_->image;
}
const FrameStats& Frame::stats() const {
    return state_->stats;
}

const std::vector<int64_t>& Frame::ids() const {
    state_->read_ids();
    return state_->ids;
}

const std::vector<int32_t>& Frame::layers() const {
    state_->read_ids();
    return state_->layers;
}

const std::vector<float>& Frame::depth() const {
    state_->read_surface();
    return state_->depth;
}

const std::vector<double>& Frame::world() const {
    state_->read_surface();
    return state_->world;
}

std::vector<PickedFeature> Frame::pick(int x, int y) const {
    if (x < 0 || y < 0 || x >= width() || y >= height())
        throw Error(ErrorKind::input, "pixel (" + std::to_string(x) + ", " + std::to_string(y) +
                                          ") lies outside the picture of " + std::to_string(width()) + " x " +
                                          std::to_string(height()));
    const size_t pixel = static_cast<size_t>(y) * static_cast<size_t>(width()) + static_cast<size_t>(x);
    const std::vector<double>& positions = world();
    std::vector<PickedFeature> picked;
    if (std::isnan(positions[3 * pixel]))
        return picked;  // sky
    const PreparedScene& scene = *state_->scene;
    SeenPoint point = seen_point(state_->request.camera, height(),
                                 {positions[3 * pixel], positions[3 * pixel + 1], positions[3 * pixel + 2]},
                                 {state_->gradients[2 * pixel], state_->gradients[2 * pixel + 1]});
    point.terrain = &scene.terrain;
    point.terrain_error = state_->request.terrain_error;
    const bool in_lens = scene.lens && scene.lens->contains(x + 0.5, y + 0.5, point.x, point.y);
    for (size_t pass = scene.passes.size(); pass-- > 0;) {
        const PreparedPass& each = scene.passes[pass];
        const Prepared& seen = in_lens && each.in_lens ? *each.in_lens : *each.prepared;
        for (const FeatureReference& reference : seen.query(point))
            picked.push_back({static_cast<int32_t>(reference.layer), scene.row_of(reference)});
    }
    return picked;
}

}  // namespace decalgl

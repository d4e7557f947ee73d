#include "frame/prepared_scene.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "decalgl/core/error.h"
#include "technique/ground_lengths.h"

namespace decalgl {
namespace {

// Positions are held as blocks of at most 32 m counted in 32 bits; heights below this are taken for holes.
constexpr double farthest = 1e10;
constexpr float highest = 1e30F;
constexpr size_t longest_ramp = 4096;

// Vertices and widths are counted in billionths of the terrain's extent; these many fit the integers.
constexpr double farthest_in_extents = 1e8;
constexpr double widest_in_extents = 1e4;

void validate_reach(const Layer& layer, const Bounds& bounds) {
    const double extent = std::max(bounds.max_x - bounds.min_x, bounds.max_y - bounds.min_y);
    for (const Stroke* stroke : {&layer.stroke, &layer.casing}) {
        const double widest = std::accumulate(stroke->widths.begin(), stroke->widths.end(), stroke->widest,
                                              [](double a, double b) { return std::max(a, b); });
        if (!(widest <= widest_in_extents * extent))
            throw Error(ErrorKind::style,
                        "layer '" + layer.name + "': a line is " + std::to_string(widest) +
                            " m wide, thousands of times the terrain's size; check the unit");
    }
    const double reach = farthest_in_extents * extent;
    // No coordinate or corner lies farther out than 1e10 m.
    if (reach > 2e10)
        return;
    for (size_t i = 0; i < layer.features.coordinates.size(); ++i) {
        if (std::abs(layer.features.coordinates[i] - (i % 2 == 0 ? bounds.min_x : bounds.min_y)) > reach)
            throw Error(ErrorKind::input, "layer '" + layer.name + "': vertex " + std::to_string(i / 2) +
                                              " is too far away for a terrain this small; check the CRS");
    }
}

void prepare_terrain(const Scene& scene, unsigned threads, Progress progress, PreparedScene& prepared) {
    const Stopwatch watch;
    progress.report(0.0);
    prepared.terrain = drawn_terrain(scene);
    validate(prepared.terrain);
    prepared.positions = PositionGrid::around(prepared.terrain.bounds());
    prepared.relief = scene.relief;
    prepared.tiles = TerrainTiles::over(prepared.terrain, threads);
    progress.report(0.7);
    prepared.illumination = illuminate(prepared.terrain, scene.relief, threads);
    progress.report(1.0);
    prepared.timings.add("terrain", watch.milliseconds());
}

void prepare_pass(const std::string& technique, const TechniqueInput& input, Progress progress,
                  PreparedScene& prepared) {
    const Stopwatch watch;
    PreparedPass pass{technique,
                      input.first_layer,
                      static_cast<uint32_t>(input.layers.size()),
                      make_technique(technique)->preprocess(input, progress),
                      nullptr,
                      reach_of(input.layers)};
    prepared.timings.add(technique, watch.milliseconds());
    // Layers without anything to draw cost no pass.
    if (pass.prepared->counts().features > 0)
        prepared.passes.push_back(std::move(pass));
}

// What one technique draws of a layer, and the layer's place in the scene.
struct LayerPart {
    Layer layer;
    uint32_t place;
};

// Polygons whose outlines have widths on the screen are two parts: their fills, and their outlines over them.
std::vector<LayerPart> parts_of(const std::vector<Layer>& layers) {
    std::vector<LayerPart> parts;
    for (size_t i = 0; i < layers.size(); ++i) {
        const Layer& layer = layers[i];
        const bool is_split = layer.features.kind == FeatureKind::polygons && !layer.fill.empty() &&
                              !layer.stroke.empty() && layer.stroke.follows_view();
        if (is_split && layer.outline_order == OutlineOrder::feature)
            throw Error(ErrorKind::unsupported,
                        "layer '" + layer.name +
                            "': outlines with widths on the screen lie over all fills of their layer; give "
                            "order='layer', or width_units='m'");
        parts.push_back({layer, static_cast<uint32_t>(i)});
        if (!is_split)
            continue;
        parts.push_back(parts.back());
        parts[parts.size() - 2].layer.stroke = Stroke();
        parts[parts.size() - 2].layer.technique = TechniqueChoice{"static", nullptr};
        parts.back().layer.fill = Fill();
    }
    return parts;
}

// Calls on_run(technique, input) for each run of layers that one technique draws.
template <typename OnRun>
void for_each_run(const Scene& scene, const RendererOptions& options, const MemoryAccount& memory,
                  const PreparedScene& prepared, OnRun on_run) {
    TechniqueInput input;
    input.terrain = &prepared.terrain;
    input.bounds = prepared.terrain.bounds();
    input.positions = prepared.positions;
    input.threads = options.threads;
    input.memory = memory;
    input.bvh = options.bvh;
    const std::vector<LayerPart> parts = parts_of(scene.layers);
    size_t end = 0;
    for (size_t begin = 0; begin < parts.size(); begin = end) {
        const TechniqueChoice& choice = parts[begin].layer.technique;
        std::vector<Layer> run;
        for (; end < parts.size() && parts[end].layer.technique == choice; ++end) {
            run.push_back(parts[end].layer);
            if (choice.name == "static")
                run.back().features = on_ground(run.back().features, run.back(), prepared.terrain, memory);
        }
        input.layers = run;
        input.first_layer = parts[begin].place;
        const std::string technique =
            choice.name == "static" && options.index == "bvh" ? "static_bvh" : choice.name;
        on_run(technique, input);
    }
}

void prepare_layers(const Scene& scene, const RendererOptions& options, const MemoryAccount& memory,
                    Progress progress, PreparedScene& prepared) {
    const bool has_ground = scene.terrain.rows() > 1 && scene.terrain.columns() > 1;
    if (scene.layers.empty() || !has_ground)
        return;
    for (const Layer& layer : scene.layers)
        validate_reach(layer, prepared.terrain.bounds());
    for_each_run(scene, options, memory, prepared,
                 [&](const std::string& technique, const TechniqueInput& input) {
                     prepare_pass(technique, input, progress, prepared);
                 });
}

}  // namespace

Heightfield drawn_terrain(const Scene& scene) {
    return scene.exaggeration == 1.0 ? scene.terrain : scene.terrain.exaggerated(scene.exaggeration);
}

void validate(const Heightfield& terrain) {
    const Bounds bounds = terrain.bounds();
    for (const double value : {bounds.min_x, bounds.min_y, bounds.max_x, bounds.max_y}) {
        if (!(std::abs(value) <= farthest))
            throw Error(ErrorKind::input,
                        "terrain: it reaches farther than 1e10 m from the origin; move it closer");
    }
    if (terrain.lowest() < -highest || terrain.highest() > highest)
        throw Error(ErrorKind::input, "terrain: a height is beyond 1e30 m; mark missing samples with NaN");
}

void validate(const Relief& relief) {
    const double values[] = {relief.lowest,   relief.highest,  relief.azimuth,
                             relief.altitude, relief.strength, relief.on_layers};
    if (!std::all_of(std::begin(values), std::end(values), [](double value) { return std::isfinite(value); }))
        throw Error(ErrorKind::input, "relief: all its numbers must be finite");
    if (relief.ramp.size() % 3 != 0 || relief.ramp.size() > 3 * longest_ramp)
        throw Error(ErrorKind::input, "relief: the ramp must be red, green and blue of at most " +
                                          std::to_string(longest_ramp) + " colours");
}

void take_sources(const Scene& scene, const RendererOptions& options, const MemoryAccount& memory,
                  PreparedScene& opened) {
    for_each_run(scene, options, memory, opened,
                 [&](const std::string& technique, const TechniqueInput& input) {
                     for (PreparedPass& pass : opened.passes)
                         if (pass.technique == technique && pass.first_layer == input.first_layer)
                             if (auto with_sources = pass.prepared->with_sources(input))
                                 pass.prepared = std::move(with_sources);
                 });
}

std::shared_ptr<PreparedScene> prepare_scene(const Scene& scene, const RendererOptions& options,
                                             const MemoryAccount& memory, const ProgressFn& progress) {
    const Stopwatch watch;
    auto prepared = std::make_shared<PreparedScene>();
    validate(scene.relief);
    for (const Layer& layer : scene.layers) {
        validate(layer);
        const Features& features = layer.features;
        prepared->layers.push_back({layer.name, features.kind, {features.rows, features.storage}});
    }
    prepare_terrain(scene, options.threads, Progress(progress, "terrain"), *prepared);
    prepared->fingerprint = SceneFingerprint(prepared->terrain, scene.relief, scene.layers, options.threads);
    prepare_layers(scene, options, memory, Progress(progress, "layers"), *prepared);
    prepared->milliseconds = watch.milliseconds();
    return prepared;
}

}  // namespace decalgl

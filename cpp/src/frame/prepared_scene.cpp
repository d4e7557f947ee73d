#include "frame/prepared_scene.h"

#include <utility>

namespace decalgl {
namespace {

void prepare_terrain(const Scene& scene, unsigned threads, Progress progress, PreparedScene& prepared) {
    const Stopwatch watch;
    progress.report(0.0);
    prepared.terrain = scene.exaggeration == 1.0 ? scene.terrain : scene.terrain.exaggerated(scene.exaggeration);
    prepared.positions = PositionGrid::around(prepared.terrain.bounds());
    prepared.relief = scene.relief;
    prepared.tiles = TerrainTiles::over(prepared.terrain, threads);
    progress.report(0.7);
    prepared.illumination = illuminate(prepared.terrain, scene.relief, threads);
    progress.report(1.0);
    prepared.timings.add("terrain", watch.milliseconds());
}

void prepare_layers(const Scene& scene, unsigned threads, const MemoryAccount& memory, Progress progress,
                    PreparedScene& prepared) {
    if (scene.layers.empty()) return;
    const Stopwatch watch;
    TechniqueInput input;
    input.layers = scene.layers;
    input.bounds = prepared.terrain.bounds();
    input.positions = prepared.positions;
    input.threads = threads;
    input.memory = memory;
    PreparedPass pass;
    pass.technique = "static";
    pass.prepared = make_technique(pass.technique)->preprocess(input, progress);
    prepared.passes.push_back(std::move(pass));
    prepared.timings.add("static", watch.milliseconds());
}

}  // namespace

std::shared_ptr<const PreparedScene> prepare_scene(const Scene& scene, unsigned threads, const MemoryAccount& memory,
                                                   const ProgressFn& progress) {
    const Stopwatch watch;
    auto prepared = std::make_shared<PreparedScene>();
    for (const Layer& layer : scene.layers) {
        validate(layer);
        prepared->features.push_back(layer.features);
    }
    prepare_terrain(scene, threads, Progress(progress, "terrain"), *prepared);
    prepare_layers(scene, threads, memory, Progress(progress, "layers"), *prepared);
    prepared->milliseconds = watch.milliseconds();
    return prepared;
}

}  // namespace decalgl

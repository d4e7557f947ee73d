// Prepared scenes on disk: an archive (core/archive.h) of what a picture needs, without the scene's vectors.
//
//     scene, relief ramp      the terrain's place and look        passes/0/technique   who reads the rest
//     heights, illumination,  as the renderer has them            passes/0/...         of that technique
//     tiles                                                       passes/1/...
//     layers, names,          what ids and picks are told as      fingerprint          of the scene
//     layers/0/rows ...
//
// Arrays are used where they lie in the mapped file; what is small is copied. All of it is checked before
// anything is drawn.
#pragma once

#include "frame/prepared_scene.h"

namespace decalgl {

void save_scene(const PreparedScene& scene, const std::string& path, unsigned threads, Progress progress);

// Throws Error(file) that says what is wrong with the file and what to do.
std::shared_ptr<PreparedScene> open_scene(const std::string& path, unsigned threads,
                                          const MemoryAccount& memory);

// Opens `cache` where it was saved from this very scene; else prepares the scene and saves it there. A
// damaged file and one of another version or scene are replaced; any other file is not, with Error(file).
std::shared_ptr<PreparedScene> prepare_cached(const Scene& scene, const std::string& cache,
                                              const RendererOptions& options, const MemoryAccount& memory,
                                              const ProgressFn& progress);

// What a file holds, from its table and its small sections alone.
struct SavedScene {
    uint32_t format = 0;
    uint64_t bytes = 0;
    int32_t rows = 0;  // of samples
    int32_t columns = 0;
    Bounds bounds;
    std::vector<PreparedLayer> layers;
    std::vector<std::pair<std::string, uint64_t>> sections;  // their bytes
};
SavedScene describe_saved_scene(const std::string& path);
bool is_saved_scene(const std::string& path);

}  // namespace decalgl

// The renderer: preprocess a scene, update to a camera, render a frame.
//
// Threads: a renderer belongs to the thread that calls `update` first; `preprocess` alone may run on any
// thread, and touches no GL. A failed call leaves the renderer as it was.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "decalgl/core/progress.h"
#include "decalgl/frame/frame.h"
#include "decalgl/frame/picture_request.h"
#include "decalgl/frame/scene.h"

namespace decalgl {

struct RendererOptions {
    int width = 1280;
    int height = 720;
    Antialias antialias = Antialias::coverage;
    double terrain_error =
        0.5;                    // pixels on the screen that the terrain's level of detail may be off; 0: none
    uint64_t memory_limit = 0;  // bytes for prepared data and GL objects together; 0: no limit
    std::string backend = "auto";  // "egl", "osmesa"
    unsigned threads = 0;          // for preprocessing; 0: all cores
    int rectangle = 0;             // largest side, in pixels, drawn at once; 0: chosen
    std::string index = "grid";    // of static layers: "grid", or "bvh" for the published structures
    BvhOptions bvh;
};

class Renderer {
public:
    // Throws Error(input) for options out of range. Opens no GL yet.
    explicit Renderer(RendererOptions options = {});

    const RendererOptions& options() const;
    // Takes effect at the next update.
    void set_picture(int width, int height, Antialias antialias);

    void preprocess(const Scene& scene, const ProgressFn& progress = {});
    // Throws Error(graphics) where no GL can be had, naming what was tried and what to install.
    UpdateReport update(const Camera& camera);
    Frame render(const Background& background = {});

    // Milliseconds of the pass that overlay passes are measured against, at the current picture.
    double time_floor();

private:
    std::shared_ptr<struct RendererState> state_;
};

}  // namespace decalgl

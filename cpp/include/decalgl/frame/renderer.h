// The renderer: preprocess a scene or open a saved one, update to a camera, render a frame.
//
// Threads: a renderer belongs to the thread that calls `update` first; `preprocess`, `save` and `open` may run
// on any thread, and touch no GL. A failed call leaves the renderer as it was.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "decalgl/core/progress.h"
#include "decalgl/frame/frame.h"
#include "decalgl/frame/lens.h"
#include "decalgl/frame/picture_request.h"
#include "decalgl/frame/prepared_layer.h"
#include "decalgl/frame/scene.h"
#include "decalgl/vector/layer_edit.h"

namespace decalgl {

struct RendererOptions {
    int width = 1280;
    int height = 720;
    Antialias antialias = Antialias::coverage;
    int samples = 8;  // a pixel, of ssaa and msaa: 1, 2, 4, 8, 16 or 32
    double terrain_error =
        0.5;                    // pixels on the screen that the terrain's level of detail may be off; 0: none
    uint64_t memory_limit = 0;  // bytes for prepared data and GL objects together; 0: no limit
    std::string backend = "auto";  // "egl", "osmesa"
    unsigned threads = 0;          // for preprocessing; 0: all cores
    int rectangle = 0;             // largest side, in pixels, drawn at once; 0: chosen
    std::string index = "grid";    // of static layers: "grid", or "bvh" for the published structures
    BvhOptions bvh;
    CoverageRule coverage = CoverageRule::exact;  // thoeny: of lines, with index "bvh"
};

class Renderer {
public:
    // Throws Error(input) for options out of range. Opens no GL yet.
    explicit Renderer(RendererOptions options = {});

    const RendererOptions& options() const;
    // Takes effect at the next update.
    void set_picture(int width, int height, Antialias antialias);

    // `cache`: a file of save() or of an earlier call, opened where it was saved from this very scene; else
    // the scene is prepared and saved there. Empty: none. Throws Error(file) too.
    void preprocess(const Scene& scene, const ProgressFn& progress = {}, const std::string& cache = {});

    // Writes what is prepared. The file is there as a whole or not at all. Throws Error(input) where nothing is
    // prepared, Error(file).
    void save(const std::string& path) const;
    // In place of preprocess: maps a file of save(), and draws the same bytes as the renderer that saved it.
    // The file must not be overwritten in place while it is in use; save() puts a new one in its place.
    // Throws Error(file) that says what is wrong with the file and what to do.
    void open(const std::string& path);

    // Changes of what is prepared, seen by the next render(); frames made before stay right. preprocess() and
    // open() end them. All throw Error(input) where nothing is prepared.

    // Other looks of layers, without preparing anew. Throws Error(style) for what needs that, Error(unsupported)
    // for an index that cannot.
    LayerLook look(uint32_t layer) const;
    void restyle(const std::vector<LayerLook>& looks);
    // Features of a layer added, removed or given another geometry, with an update of what lies around them alone.
    // Throws Error(unsupported) where what is prepared was opened from a file.
    void edit(const LayerEdit& edit);
    // Other looks inside a lens; what they leave open is as outside.
    void set_lens(const Lens& lens, const std::vector<LayerLook>& looks);
    // Nothing is made or uploaded but the lens itself.
    void move_lens(const Lens& lens);
    void remove_lens();

    // Of what is prepared. Throw Error(input) where nothing is.
    std::vector<PreparedLayer> layers() const;
    Bounds bounds() const;

    // What has not changed since the last picture is neither updated nor drawn again: the same view of the same
    // scene costs nothing. Throws Error(graphics) where no GL can be had, naming what was tried and what to install.
    UpdateReport update(const Camera& camera);
    Frame render(const Background& background = {});
    // The next update and picture begin anew, for those who time them; those of the ground only if asked for. What is
    // uploaded stays.
    void forget(bool ground);

    // Milliseconds of the pass that overlay passes are measured against, at the current picture.
    double time_floor();
    // Samples that the layers write in one more drawing of the current picture.
    uint64_t count_fragments();

private:
    std::shared_ptr<struct RendererState> state_;
};

}  // namespace decalgl

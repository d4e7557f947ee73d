// A scene made ready on the CPU: everything a picture needs, and no GL.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "decalgl/core/timing.h"
#include "decalgl/frame/prepared_layer.h"
#include "decalgl/frame/renderer.h"
#include "decalgl/frame/scene.h"
#include "decalgl/technique/technique.h"
#include "decalgl/terrain/tiles.h"
#include "frame/fingerprint.h"

namespace decalgl {

// Neighbouring layers of one technique are one pass.
struct PreparedPass {
    std::string technique;
    std::shared_ptr<const Prepared> prepared;
};

struct PreparedScene {
    Heightfield terrain;  // exaggerated
    TerrainTiles tiles;
    Relief relief;
    SharedArray<uint8_t> illumination;
    PositionGrid positions;
    std::vector<PreparedPass> passes;  // bottom to top
    std::vector<PreparedLayer> layers;
    SceneFingerprint fingerprint;
    TimingLog timings{true};
    double milliseconds = 0.0;

    int64_t row_of(FeatureReference reference) const {
        return layers[reference.layer].rows[reference.feature];
    }
};

// The terrain of a scene as it is drawn: exaggerated.
Heightfield drawn_terrain(const Scene& scene);

// Throw Error(input) for what cannot be drawn.
void validate(const Heightfield& terrain);
void validate(const Relief& relief);

// Validates and prepares. Throws Error(input), Error(memory), Error(cancelled).
std::shared_ptr<PreparedScene> prepare_scene(const Scene& scene, const RendererOptions& options,
                                             const MemoryAccount& memory, const ProgressFn& progress);

}  // namespace decalgl

// A scene made ready on the CPU: everything a picture needs, and no GL.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "decalgl/core/timing.h"
#include "decalgl/frame/lens.h"
#include "decalgl/frame/prepared_layer.h"
#include "decalgl/frame/renderer.h"
#include "decalgl/frame/scene.h"
#include "decalgl/technique/technique.h"
#include "decalgl/terrain/tiles.h"
#include "frame/fingerprint.h"
#include "frame/map_reach.h"

namespace decalgl {

// Neighbouring layers of one technique are one pass.
struct PreparedPass {
    std::string technique;
    uint32_t first_layer = 0;
    uint32_t layer_count = 0;
    std::shared_ptr<const Prepared> prepared;
    std::shared_ptr<const Prepared> in_lens;  // what is seen inside the lens; null where it is the same
    MapReach reach;

    bool has_layer(uint32_t layer) const { return layer - first_layer < layer_count; }

    bool shows_anything() const {
        return prepared->shows_anything() || (in_lens && in_lens->shows_anything());
    }
};

// Copies are cheap: whatever is large is shared.
struct PreparedScene {
    Heightfield terrain;  // exaggerated
    TerrainTiles tiles;
    Relief relief;
    SharedArray<uint8_t> illumination;
    PositionGrid positions;
    std::vector<PreparedPass> passes;  // bottom to top
    std::vector<PreparedLayer> layers;
    std::shared_ptr<const Lens> lens;  // null: none
    std::vector<LayerLook> lens_looks;
    SceneFingerprint fingerprint;
    TimingLog timings{true};
    double milliseconds = 0.0;

    int64_t row_of(FeatureReference reference) const {
        return layers[reference.layer].rows[reference.feature];
    }
    bool shares_ground(const PreparedScene& other) const {
        return illumination.data() == other.illumination.data();
    }
};

// The terrain of a scene as it is drawn: exaggerated.
Heightfield drawn_terrain(const Scene& scene);

// Throw Error(input) for what cannot be drawn.
void validate(const Heightfield& terrain);
void validate(const Relief& relief);

// Gives the index of a scene that was opened what it was made of, for later edits.
void take_sources(const Scene& scene, const RendererOptions& options, const MemoryAccount& memory,
                  PreparedScene& opened);

// Validates and prepares. Throws Error(input), Error(memory), Error(cancelled).
std::shared_ptr<PreparedScene> prepare_scene(const Scene& scene, const RendererOptions& options,
                                             const MemoryAccount& memory, const ProgressFn& progress);

}  // namespace decalgl

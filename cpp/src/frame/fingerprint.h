// Fingerprints of scenes: whether a saved file was made from this very scene.
#pragma once

#include <optional>
#include <vector>

#include "core/digest.h"
#include "decalgl/terrain/heightfield.h"
#include "decalgl/terrain/relief.h"
#include "decalgl/vector/layer.h"

namespace decalgl {

// Everything that goes into a prepared scene. Nothing is read of coordinates and heights until they are asked
// for, since few scenes are ever saved: they are shared, and styles, which are not, are digested at once.
class SceneFingerprint {
public:
    SceneFingerprint() = default;
    explicit SceneFingerprint(const Digest& known) : known_(known) {}
    // `terrain`: as drawn.
    SceneFingerprint(const Heightfield& terrain, const Relief& relief, const std::vector<Layer>& layers,
                     unsigned threads);

    Digest digest(unsigned threads) const;

private:
    std::optional<Digest> known_;
    Heightfield terrain_;
    Digest look_;
    std::vector<Features> features_;
};

}  // namespace decalgl

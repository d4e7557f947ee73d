#include "frame/scene_changes.h"

#include <algorithm>
#include <string>
#include <utility>

#include "decalgl/core/error.h"

namespace decalgl {
namespace {

void require_layers(const PreparedScene& scene, Span<const LayerLook> looks) {
    for (const LayerLook& look : looks) {
        require_layer(scene, look.layer);
        const PreparedLayer& layer = scene.layers[look.layer];
        validate(look, layer.rows.size(), layer.name);
    }
}

// Errors of a technique do not know the layer's name.
std::shared_ptr<const Prepared> restyled(const PreparedScene& scene, const Prepared& prepared,
                                         Span<const LayerLook> looks, const MemoryAccount& memory) {
    try {
        return prepared.restyled(looks, memory);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::style || looks.size() != 1)
            throw;
        throw Error(ErrorKind::style, "layer '" + scene.layers[looks[0].layer].name + "': " + error.what());
    }
}

void look_through_lens(PreparedScene& scene, const MemoryAccount& memory) {
    for (PreparedPass& pass : scene.passes)
        pass.in_lens = scene.lens ? restyled(scene, *pass.prepared, scene.lens_looks, memory) : nullptr;
}

}  // namespace

void require_layer(const PreparedScene& scene, uint32_t layer) {
    if (layer >= scene.layers.size())
        throw Error(ErrorKind::input, "there is no layer " + std::to_string(layer) + "; the scene has " +
                                          std::to_string(scene.layers.size()));
}

std::shared_ptr<const PreparedScene> restyled_scene(const PreparedScene& scene, Span<const LayerLook> looks,
                                                    const MemoryAccount& memory) {
    require_layers(scene, looks);
    auto changed = std::make_shared<PreparedScene>(scene);
    changed->fingerprint = SceneFingerprint(Digest{});
    for (PreparedPass& pass : changed->passes)
        pass.prepared = restyled(scene, *pass.prepared, looks, memory);
    look_through_lens(*changed, memory);
    return changed;
}

std::shared_ptr<const PreparedScene> scene_with_lens(const PreparedScene& scene,
                                                     std::shared_ptr<const Lens> lens,
                                                     std::vector<LayerLook> looks,
                                                     const MemoryAccount& memory) {
    if (lens)
        validate(*lens);
    require_layers(scene, looks);
    const bool reorders = std::any_of(looks.begin(), looks.end(),
                                      [](const LayerLook& look) { return !look.draw_order.empty(); });
    if (reorders)
        throw Error(ErrorKind::unsupported,
                    "the draw order inside a lens is that of the whole picture; restyle the layer instead");
    auto changed = std::make_shared<PreparedScene>(scene);
    changed->lens = std::move(lens);
    changed->lens_looks = std::move(looks);
    look_through_lens(*changed, memory);
    return changed;
}

std::shared_ptr<const PreparedScene> scene_with_moved_lens(const PreparedScene& scene,
                                                           std::shared_ptr<const Lens> lens) {
    if (!scene.lens)
        throw Error(ErrorKind::input, "there is no lens to move; set one first");
    validate(*lens);
    auto changed = std::make_shared<PreparedScene>(scene);
    changed->lens = std::move(lens);
    return changed;
}

}  // namespace decalgl

// Changes to a prepared scene without preparing it anew. Each makes a new one that shares whatever stays, so frames of
// the one before stay right.
//
// A scene that was changed is not what its scene's fingerprint says: it is saved under none.
#pragma once

#include "frame/prepared_scene.h"

namespace decalgl {

// Throws Error(input) where the scene has no such layer.
void require_layer(const PreparedScene& scene, uint32_t layer);

// Layers with other looks, inside the lens as well where that does not say otherwise. Throws Error(style), Error(input),
// Error(unsupported), Error(memory).
std::shared_ptr<const PreparedScene> restyled_scene(const PreparedScene& scene, Span<const LayerLook> looks,
                                                    const MemoryAccount& memory);

// With features of a layer added, removed or replaced. What is added is seen inside the lens as outside. Throws what
// Prepared::edited does.
std::shared_ptr<const PreparedScene> edited_scene(const PreparedScene& scene, const LayerEdit& edit,
                                                  const MemoryAccount& memory);

// With a lens that shows these looks, or without one where it is null.
std::shared_ptr<const PreparedScene> scene_with_lens(const PreparedScene& scene,
                                                     std::shared_ptr<const Lens> lens,
                                                     std::vector<LayerLook> looks,
                                                     const MemoryAccount& memory);

// The lens elsewhere. Throws Error(input) where there is none.
std::shared_ptr<const PreparedScene> scene_with_moved_lens(const PreparedScene& scene,
                                                           std::shared_ptr<const Lens> lens);

}  // namespace decalgl

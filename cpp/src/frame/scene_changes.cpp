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

// Whether fills and outlines of a layer are of two passes.
bool is_split(const PreparedScene& scene, uint32_t layer) {
    return std::count_if(scene.passes.begin(), scene.passes.end(),
                         [&](const PreparedPass& pass) { return pass.has_layer(layer); }) > 1;
}

// The looks of a pass's own layers, and of a layer that two passes share, its own part: fills lie in the one below.
std::vector<LayerLook> looks_of(const PreparedScene& scene, const PreparedPass& pass,
                                Span<const LayerLook> looks) {
    std::vector<LayerLook> own;
    for (const LayerLook& look : looks) {
        if (!pass.has_layer(look.layer))
            continue;
        own.push_back(look);
        if (!is_split(scene, look.layer))
            continue;
        const bool has_fills =
            pass.first_layer + pass.layer_count == look.layer + 1 && pass.technique != "dynamic";
        if (has_fills)
            own.back().stroke = DecalLook();
        else
            own.back().fill = DecalLook();
    }
    return own;
}

// What a pass is with other looks; null where none are its own. Errors of a technique do not know the layer's name.
std::shared_ptr<const Prepared> restyled(const PreparedScene& scene, const PreparedPass& pass,
                                         Span<const LayerLook> all_looks, const MemoryAccount& memory) {
    const std::vector<LayerLook> looks = looks_of(scene, pass, all_looks);
    if (looks.empty())
        return nullptr;
    try {
        return pass.prepared->restyled(looks, memory);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::style || looks.size() != 1)
            throw;
        throw Error(ErrorKind::style, "layer '" + scene.layers[looks[0].layer].name + "': " + error.what());
    }
}

// The look of added features at the end of what a lens shows, where that is one a feature.
void append(const DecalLook& added, size_t count, size_t features, DecalLook& look) {
    if (look.colors.size() == 4 * features && !added.colors.empty())
        for (size_t i = 0; i < count; ++i)
            look.colors.insert(look.colors.end(), added.color(i), added.color(i) + 4);
    if (look.widths.size() == features && !added.widths.empty())
        for (size_t i = 0; i < count; ++i)
            look.widths.push_back(added.width(i));
    // Whatever else their styles are is that of the layer's first feature.
    for (std::vector<uint32_t>* places : {&look.style_of, &look.hatch_of})
        if (places->size() == features)
            places->resize(features + count, places->front());
}

void append(const LayerEdit& edit, size_t features, LayerLook& look) {
    append(edit.fill, edit.added_count(), features, look.fill);
    append(edit.stroke, edit.added_count(), features, look.stroke);
    append(edit.casing, edit.added_count(), features, look.casing);
    if (!look.draw_order.empty())
        for (size_t i = 0; i < edit.added_count(); ++i)
            look.draw_order.push_back(static_cast<int64_t>(features + i));
}

void look_through_lens(PreparedScene& scene, const MemoryAccount& memory) {
    for (PreparedPass& pass : scene.passes)
        pass.in_lens = scene.lens ? restyled(scene, pass, scene.lens_looks, memory) : nullptr;
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
        if (auto prepared = restyled(scene, pass, looks, memory))
            pass.prepared = std::move(prepared);
    look_through_lens(*changed, memory);
    return changed;
}

std::shared_ptr<const PreparedScene> edited_scene(const PreparedScene& scene, const LayerEdit& edit,
                                                  const MemoryAccount& memory) {
    require_layer(scene, edit.layer);
    const PreparedLayer& layer = scene.layers[edit.layer];
    validate(edit, layer.kind, layer.rows.size(), layer.name);
    if (is_split(scene, edit.layer))
        throw Error(ErrorKind::unsupported, "layer '" + layer.name +
                                                "': polygons whose outlines have widths on the screen cannot "
                                                "be edited; prepare the scene anew");
    auto changed = std::make_shared<PreparedScene>(scene);
    const auto pass = std::find_if(changed->passes.begin(), changed->passes.end(),
                                   [&](const PreparedPass& each) { return each.has_layer(edit.layer); });
    if (pass == changed->passes.end())
        throw Error(ErrorKind::unsupported,
                    "layers without features have no index to edit; prepare the scene anew with the first of "
                    "them");
    changed->fingerprint = SceneFingerprint(Digest{});
    pass->prepared = pass->prepared->edited(edit, memory);
    extend(pass->reach, edit);
    std::vector<int64_t> rows(layer.rows.begin(), layer.rows.end());
    const Span<const int64_t> added = edit.geometry.rows.subspan(edit.replaced.size(), edit.added_count());
    rows.insert(rows.end(), added.begin(), added.end());
    changed->layers[edit.layer].rows = std::move(rows);
    for (LayerLook& look : changed->lens_looks)
        if (look.layer == edit.layer)
            append(edit, layer.rows.size(), look);
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

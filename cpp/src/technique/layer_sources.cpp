#include "technique/layer_sources.h"

#include <utility>

#include "decalgl/core/error.h"
#include "technique/ground_lengths.h"

namespace decalgl {
namespace {

void add_color(const uint8_t* color, std::vector<uint8_t>& colors) {
    colors.insert(colors.end(), color, color + 4);
}

// Nothing to be seen, where there have to be styles although there is no feature.
void keep_styles(const Stroke& like, Stroke& stroke) {
    if (!like.empty() && stroke.empty()) {
        stroke.colors = {0, 0, 0, 0};
        stroke.widths = {0.0};
    }
}

// Features with their looks, one after the other, as a layer with the styles of another one.
class LayerGatherer {
public:
    explicit LayerGatherer(const Layer& like) : like_(like) {
        layer_.name = like.name;
        layer_.features.kind = like.features.kind;
        layer_.outline_mode = like.outline_mode;
        layer_.outline_order = like.outline_order;
        layer_.fill.hatches = like.fill.hatches;
        layer_.stroke.styles = like.stroke.styles;
        layer_.stroke.widest = like.stroke.widest;
        layer_.casing.styles = like.casing.styles;
        layer_.casing.widest = like.casing.widest;
    }

    void add_geometry(const Features& features, size_t feature) {
        for (auto part = static_cast<size_t>(features.feature_offsets[feature]);
             part < static_cast<size_t>(features.feature_offsets[feature + 1]); ++part) {
            const Span<const double> vertices = features.part(part);
            coordinates_.insert(coordinates_.end(), vertices.begin(), vertices.end());
            const Span<const float> slants = features.slants_of(part);
            slants_.insert(slants_.end(), slants.begin(), slants.end());
            part_offsets_.push_back(static_cast<int64_t>(coordinates_.size() / 2));
        }
        feature_offsets_.push_back(static_cast<int64_t>(part_offsets_.size()) - 1);
    }

    void add_look(const Layer& from, size_t feature) {
        if (!from.fill.empty()) {
            add_color(from.fill.color(feature), layer_.fill.colors);
            layer_.fill.hatch_of.push_back(static_cast<uint32_t>(from.fill.hatch(feature)));
        }
        add_stroke(from.stroke, feature, layer_.stroke);
        add_stroke(from.casing, feature, layer_.casing);
    }

    // The look of an added feature.
    void add_look(const LayerEdit& edit, size_t added) {
        Layer look;
        if (!like_.fill.empty()) {
            add_color(color_of(edit.fill, added), look.fill.colors);
            look.fill.hatch_of = {static_cast<uint32_t>(like_.fill.hatch(0))};
        }
        look.stroke = added_stroke(like_.stroke, edit.stroke, added);
        look.casing = added_stroke(like_.casing, edit.casing, added);
        add_look(look, 0);
    }

    Layer finish() {
        if (!like_.fill.empty() && layer_.fill.empty())
            layer_.fill.colors = {0, 0, 0, 0};
        keep_styles(like_.stroke, layer_.stroke);
        keep_styles(like_.casing, layer_.casing);
        layer_.features =
            Features::own(layer_.features.kind, std::move(coordinates_), std::move(part_offsets_),
                          std::move(feature_offsets_), {}, std::move(slants_));
        return std::move(layer_);
    }

private:
    static const uint8_t* color_of(const DecalLook& look, size_t added) {
        static constexpr uint8_t hidden[4] = {0, 0, 0, 0};
        return look.colors.empty() ? hidden : look.color(added);
    }

    static Stroke added_stroke(const Stroke& like, const DecalLook& look, size_t added) {
        Stroke stroke;
        if (like.empty())
            return stroke;
        add_color(color_of(look, added), stroke.colors);
        stroke.widths = {look.widths.empty() ? 0.0 : look.width(added)};
        stroke.style_of = {like.style_of.empty() ? 0 : like.style_of.front()};
        return stroke;
    }

    static void add_stroke(const Stroke& from, size_t feature, Stroke& to) {
        if (from.empty())
            return;
        add_color(from.color(feature), to.colors);
        to.widths.push_back(from.width(feature));
        to.style_of.push_back(static_cast<uint32_t>(from.style(feature)));
    }

    const Layer& like_;
    Layer layer_;
    std::vector<double> coordinates_;
    std::vector<float> slants_;
    std::vector<int64_t> part_offsets_{0};
    std::vector<int64_t> feature_offsets_{0};
};

// Places are those in the scene: what other techniques draw below is left empty.
std::vector<Layer> layers_from_first(const TechniqueInput& input) {
    std::vector<Layer> layers(input.first_layer);
    layers.insert(layers.end(), input.layers.begin(), input.layers.end());
    return layers;
}

}  // namespace

LayerSources::LayerSources(const TechniqueInput& input)
    : base_(std::make_shared<const std::vector<Layer>>(layers_from_first(input))),
      input_(*base_),
      patched_(base_->size()),
      removed_(base_->size()),
      memory_(input.memory) {
    if (input.terrain != nullptr)
        ground_ = *input.terrain;
    for (const Layer& layer : *base_)
        counts_.push_back(layer.features.feature_count());
}

LayerSources::Place LayerSources::find(size_t layer, uint32_t feature) const {
    if (patched_[layer].empty())
        return {&input_[layer], feature};
    const auto patched = patched_[layer].find(feature);
    return patched == patched_[layer].end() ? Place{&input_[layer], feature} : patched->second;
}

const StrokeStyle& LayerSources::style_of(const Decal& decal) const {
    const Place place = find(decal.feature.layer, decal.feature.feature);
    const Stroke& stroke = decal.role == DecalRole::casing ? place.layer->casing : place.layer->stroke;
    return stroke.styles[stroke.style(place.feature)];
}

Layer LayerSources::make_patch(const LayerEdit& edit) const {
    const Layer& like = input_[edit.layer];
    const Features geometry = on_ground(edit.geometry, like, ground_, memory_);
    LayerGatherer patch(like);
    for (size_t i = 0; i < geometry.feature_count(); ++i) {
        patch.add_geometry(geometry, i);
        if (i < edit.replaced.size()) {
            const Place old = find(edit.layer, edit.replaced[i]);
            patch.add_look(*old.layer, old.feature);
        } else {
            patch.add_look(edit, i - edit.replaced.size());
        }
    }
    return patch.finish();
}

std::shared_ptr<const LayerSources> LayerSources::edited(const LayerEdit& edit) const {
    auto result = std::make_shared<LayerSources>(*this);
    for (const std::vector<uint32_t>* features : {&edit.removed, &edit.replaced}) {
        for (const uint32_t feature : *features) {
            if (is_removed(edit.layer, feature))
                throw Error(ErrorKind::input, "layer '" + input_[edit.layer].name +
                                                  "': a feature that was removed cannot be edited");
        }
    }
    const auto patch = std::make_shared<const Layer>(make_patch(edit));
    auto& patched = result->patched_[edit.layer];
    for (size_t i = 0; i < edit.geometry.feature_count(); ++i) {
        const bool is_added = i >= edit.replaced.size();
        const auto feature =
            is_added ? static_cast<uint32_t>(result->counts_[edit.layer]++) : edit.replaced[i];
        patched[feature] = {patch.get(), i};
    }
    for (const uint32_t feature : edit.removed) {
        result->removed_[edit.layer].insert(feature);
        patched.erase(feature);
    }
    result->patches_.push_back(patch);
    return result;
}

Layer LayerSources::subset_of_layer(size_t layer, Span<const uint32_t> features) const {
    LayerGatherer gatherer(input_[layer]);
    for (const uint32_t feature : features) {
        const Place place = find(layer, feature);
        gatherer.add_geometry(place.layer->features, place.feature);
        gatherer.add_look(*place.layer, place.feature);
    }
    return gatherer.finish();
}

std::vector<Layer> LayerSources::subset(Span<const std::vector<uint32_t>> features) const {
    std::vector<Layer> layers;
    for (size_t layer = 0; layer < input_.size(); ++layer)
        layers.push_back(subset_of_layer(layer, features[layer]));
    return layers;
}

}  // namespace decalgl

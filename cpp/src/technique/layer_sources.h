// The layers that an index was made of, and what edits have made of them since: where a rebuild of some buckets finds its
// features.
//
//     base       the layers as they were prepared, shared by all versions
//     patches    features that were replaced or added, a layer an edit
#pragma once

#include <memory>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "decalgl/technique/technique.h"
#include "decalgl/terrain/heightfield.h"

namespace decalgl {

class LayerSources {
public:
    explicit LayerSources(const TechniqueInput& input);

    const std::string& name_of(size_t layer) const { return input_[layer].name; }
    // Of a stroke or casing, as it was prepared.
    const StrokeStyle& style_of(const Decal& decal) const;
    size_t layer_count() const { return input_.size(); }
    size_t feature_count(size_t layer) const { return counts_[layer]; }
    bool is_removed(size_t layer, uint32_t feature) const { return removed_[layer].count(feature) != 0; }

    // After an edit; throws Error(input) for a feature that is not there any more.
    std::shared_ptr<const LayerSources> edited(const LayerEdit& edit) const;

    // All layers with all their styles, but of each only these features in this order.
    std::vector<Layer> subset(Span<const std::vector<uint32_t>> features) const;

private:
    struct Place {
        const Layer* layer;
        size_t feature;
    };

    Place find(size_t layer, uint32_t feature) const;
    Layer make_patch(const LayerEdit& edit) const;
    Layer subset_of_layer(size_t layer, Span<const uint32_t> features) const;

    std::shared_ptr<const std::vector<Layer>> base_;
    Span<const Layer> input_;
    std::vector<std::shared_ptr<const Layer>> patches_;
    std::vector<std::unordered_map<uint32_t, Place>> patched_;  // of each layer
    std::vector<std::unordered_set<uint32_t>> removed_;
    std::vector<size_t> counts_;
    Heightfield ground_;
    MemoryAccount memory_;
};

}  // namespace decalgl

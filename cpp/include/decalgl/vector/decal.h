// Decals: what layers are composed of, one over the other. A feature is one or two of them.
//
//     lines      casings of all features, then strokes of all features
//     polygons   fills of all features, then outlines of all; or each fill with its outline (OutlineOrder)
#pragma once

#include <cstdint>
#include <vector>

#include "decalgl/core/span.h"
#include "decalgl/vector/layer.h"

namespace decalgl {

// A feature as the user knows it: the layer's place in the scene and the feature's place in the layer.
struct FeatureReference {
    uint32_t layer = 0;
    uint32_t feature = 0;
};

inline bool operator==(FeatureReference a, FeatureReference b) {
    return a.layer == b.layer && a.feature == b.feature;
}

// A clip is not drawn: it cuts the next decal off. Techniques add clips where they need them.
enum class DecalRole : uint32_t { fill, stroke, casing, clip };

struct Decal {
    FeatureReference feature;
    DecalRole role = DecalRole::fill;

    bool is_stroke() const { return role == DecalRole::stroke || role == DecalRole::casing; }
};
static_assert(sizeof(Decal) == 12, "kept on disk as it is");

// A decal with the layer that it comes from.
struct DecalView {
    const Layer* layer;
    Decal decal;

    size_t feature() const { return decal.feature.feature; }
    const Stroke& stroke() const { return decal.role == DecalRole::casing ? layer->casing : layer->stroke; }
    const uint8_t* color() const {
        return decal.is_stroke() ? stroke().color(feature()) : layer->fill.color(feature());
    }
    const StrokeStyle& style() const { return stroke().styles[stroke().style(feature())]; }
    const Hatch& hatch() const { return layer->fill.hatches[layer->fill.hatch(feature())]; }
    // Inset and offset outlines are strokes of twice the width, of which one side is cut away.
    OutlineMode cut() const {
        return layer->features.kind == FeatureKind::polygons && decal.is_stroke() ? layer->outline_mode
                                                                                  : OutlineMode::normal;
    }
    // Metres; of fills 0.
    double half_width() const;
    // What it may be widened to.
    double widest_half_width() const;
};

// Whether decals of features that are fully transparent are there, for a later restyle to show.
enum class Hidden { left_out, kept };

// The decals that show anything, from bottom to top. Layers are counted from `first_layer`.
std::vector<Decal> decals_of(Span<const Layer> layers, uint32_t first_layer,
                             Hidden hidden = Hidden::left_out);

}  // namespace decalgl

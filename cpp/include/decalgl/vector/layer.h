// A layer: features of one kind with their resolved styles and draw order.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "decalgl/vector/choice_bytes.h"
#include "decalgl/vector/features.h"
#include "decalgl/vector/stroke.h"

namespace decalgl {

// Which side of a polygon's border its outline lies on: both, or the whole width on one.
enum class OutlineMode : uint8_t { normal, inset, offset };
// Over all fills of the layer, or each over its own feature's fill.
enum class OutlineOrder : uint8_t { layer, feature };

// What one technique lets its users choose; each has its own.
class TechniqueOptions {
public:
    virtual ~TechniqueOptions() = default;
    virtual bool equals(const TechniqueOptions& other) const = 0;
    // All of them: a scene that was prepared with others is not taken from a file.
    virtual void write(ChoiceBytes& choices) const = 0;
    // Whether they say how wide lines are, and the layer's widths are not read.
    virtual bool names_widths() const { return false; }
};

// Who draws a layer, by a name of technique/registry.cpp.
struct TechniqueChoice {
    std::string name = "static";
    std::shared_ptr<const TechniqueOptions> options;  // null: the technique's own

    bool operator==(const TechniqueChoice& other) const {
        const bool same_options =
            options && other.options ? options->equals(*other.options) : options == other.options;
        return name == other.name && same_options;
    }
};

// Polygons cut into triangles, for techniques that draw meshes. Those of feature f are first_of[f] .. first_of[f + 1];
// six coordinates each, in the scene's coordinate system, either way round. They cover what the even-odd rule says,
// and nothing twice.
struct Triangles {
    std::vector<double> coordinates;
    std::vector<int64_t> first_of;  // empty: there are none
};

struct Layer {
    std::string name;
    TechniqueChoice technique;
    Features features;
    Fill fill;      // of polygons
    Stroke stroke;  // of lines; of polygons: their outlines
    Stroke casing;  // of lines: under the strokes of all features
    OutlineMode outline_mode = OutlineMode::normal;
    OutlineOrder outline_order = OutlineOrder::layer;
    Triangles triangles;  // of polygons, where a technique asks for them
    // Features from bottom to top; empty: as they stand.
    std::vector<int64_t> draw_order;

    size_t feature_at(size_t rank) const {
        return draw_order.empty() ? rank : static_cast<size_t>(draw_order[rank]);
    }
};

// Throws Error(input) that names the layer, the feature and the cure.
void validate(const Layer& layer);
// Empty, or each of the features once. Throws Error(input).
void validate_draw_order(const std::vector<int64_t>& draw_order, size_t features,
                         const std::string& layer_name);

}  // namespace decalgl

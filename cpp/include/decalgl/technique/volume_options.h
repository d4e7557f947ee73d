// What users may choose of shadow volumes.
#pragma once

#include <tuple>

#include "decalgl/vector/layer.h"

namespace decalgl::volume {

enum class Grouping : uint8_t { exact, colors };

struct VolumeOptions : TechniqueOptions {
    Grouping grouping = Grouping::exact;
    double arc_step = 11.25;  // degrees between the vertices of round corners and caps

    auto members() const { return std::make_tuple(grouping, arc_step); }
    bool equals(const TechniqueOptions& other) const override {
        const auto* options = dynamic_cast<const VolumeOptions*>(&other);
        return options != nullptr && options->members() == members();
    }
    void write(ChoiceBytes& choices) const override { choices.add(members()); }
};

}  // namespace decalgl::volume

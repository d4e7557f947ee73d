// What users choose of dynamic lines.
#pragma once

#include <cstdint>
#include <tuple>

#include "decalgl/vector/layer.h"

namespace decalgl {

// How a pixel finds its lines: by tiles of the screen, or by lists that boxes around the lines fill (Zechmeister 2020,
// section 3.3.2); automatic: bins, which are faster.
enum class LineMethod : uint32_t { automatic, bins, lists };
// As wide as on the screen, or on the ground by the distance (Zechmeister 2020, equations 4.1 and 4.2).
enum class LineWidthRule : uint32_t { screen, thesis };

struct DynamicOptions : TechniqueOptions {
    LineMethod method = LineMethod::automatic;
    LineWidthRule width_rule = LineWidthRule::screen;
    double cell =
        0.125;  // pixels: of vertices that fall together in one, a line keeps the first; 0: all are kept

    auto members() const { return std::make_tuple(method, width_rule, cell); }
    bool equals(const TechniqueOptions& other) const override {
        const auto* options = dynamic_cast<const DynamicOptions*>(&other);
        return options != nullptr && options->members() == members();
    }
    void write(ChoiceBytes& choices) const override { choices.add(members()); }
};

}  // namespace decalgl

#include "decalgl/vector/layer_look.h"

#include <cmath>
#include <string>

#include "decalgl/core/error.h"
#include "decalgl/vector/layer.h"

namespace decalgl {
namespace {

void validate(const DecalLook& look, size_t features, const std::string& layer) {
    const size_t colors = look.colors.size();
    if (colors != 0 && colors != 4 && colors != 4 * features)
        throw Error(ErrorKind::style, "layer '" + layer + "': needs one colour, or one for each of its " +
                                          std::to_string(features) + " features");
    if (look.widths.size() > 1 && look.widths.size() != features)
        throw Error(ErrorKind::style, "layer '" + layer + "': needs one width, or one for each of its " +
                                          std::to_string(features) + " features");
    const std::vector<uint8_t> any_color(4, 0);
    if (!look.styles.empty()) {
        Stroke stroke;
        stroke.colors = any_color;
        stroke.widths = {1.0};
        stroke.styles = look.styles;
        stroke.style_of = look.style_of;
        decalgl::validate(stroke, features, layer);
    }
    if (!look.hatches.empty())
        decalgl::validate(Fill{any_color, look.hatches, look.hatch_of}, features, layer);
    for (const double width : look.widths) {
        if (!(width >= 0.0 && std::isfinite(width)))
            throw Error(ErrorKind::style,
                        "layer '" + layer + "': a width must be a length in metres, 0 or more");
    }
}

}  // namespace

void validate(const LayerLook& look, size_t features, const std::string& layer_name) {
    validate(look.fill, features, layer_name);
    validate(look.stroke, features, layer_name);
    validate(look.casing, features, layer_name);
    validate_draw_order(look.draw_order, features, layer_name);
}

}  // namespace decalgl

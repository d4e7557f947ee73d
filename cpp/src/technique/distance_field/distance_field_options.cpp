#include "decalgl/technique/distance_field_options.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "decalgl/core/error.h"

namespace decalgl {
namespace {

[[noreturn]] void refuse(const std::string& message) {
    throw Error(ErrorKind::style, "distance field: " + message);
}

bool is_share(double value) {
    return value >= 0.0 && value <= 1.0;
}

bool is_color(const std::array<float, 4>& color) {
    return std::all_of(color.begin(), color.end(), [](float channel) { return is_share(channel); });
}

void validate(const NetworkStyle& style, const std::string& name) {
    if (!(style.width >= 0.0 && std::isfinite(style.width)))
        refuse("category '" + name + "': a width must be a length in metres, 0 or more");
    if (!is_share(style.main) || !is_share(style.lod) || !is_share(style.texture_share))
        refuse("category '" + name + "': lod and the shares of a style must lie between 0 and 1");
    if (!is_color(style.main_color) || !is_color(style.border_color))
        refuse("category '" + name + "': colours must have four channels between 0 and 1");
}

void validate(const NetworkCategory& category, const DistanceFieldOptions& options) {
    const std::string& name = category.name;
    if (category.styles.empty() || category.styles.size() > most_lod_styles)
        refuse("category '" + name + "' needs 1 to " + std::to_string(most_lod_styles) + " styles");
    for (size_t i = 0; i < category.styles.size(); ++i) {
        validate(category.styles[i], name);
        if (i > 0 && !(category.styles[i - 1].lod < category.styles[i].lod))
            refuse("category '" + name + "': the lod of its styles must rise");
    }
    const int caps = first_custom_cap + static_cast<int>(options.drop_offs.size());
    if (!std::all_of(category.caps.begin(), category.caps.end(),
                     [&](int cap) { return cap >= static_cast<int>(CapShape::round) && cap < caps; }))
        refuse("category '" + name + "': there is no such cap");
    if (category.raster >= static_cast<int>(options.rasters.size()))
        refuse("category '" + name + "': there is no such raster");
    const auto is_length = [](double value) { return value > 0.0 && std::isfinite(value); };
    if (!is_length(category.raster_length) || !is_length(category.sketch.length) ||
        !is_share(category.sketch.amplitude))
        refuse("category '" + name + "': lengths must be above 0, and a sketch's amplitude from 0 to 1");
    if (category.pattern.marks.size() > most_pattern_marks || !(category.pattern.period >= 0.0))
        refuse("category '" + name + "': a pattern has a period and at most " +
               std::to_string(most_pattern_marks) + " marks");
}

void validate(const LevelOfDetail& lod) {
    if (!is_share(lod.value))
        refuse("a level of detail must lie between 0 and 1");
    if (lod.source == LodSource::distance && !(lod.near < lod.far && std::isfinite(lod.far)))
        refuse("levels of detail need a near distance below the far one");
    if (lod.source != LodSource::texture)
        return;
    const size_t texels =
        static_cast<size_t>(std::max(lod.width, 0)) * static_cast<size_t>(std::max(lod.height, 0));
    if (texels == 0 || lod.texels.size() != texels)
        refuse("a texture of levels of detail must have the shape (rows, columns)");
    if (!(lod.extent[0] < lod.extent[2] && lod.extent[1] < lod.extent[3]))
        refuse("the extent of a texture of levels of detail must be (x0, y0, x1, y1)");
}

void write_category(const NetworkCategory& category, ChoiceBytes& choices) {
    choices.add(category.name);
    choices.add(category.styles.size());
    for (const NetworkStyle& style : category.styles)
        choices.add(std::tie(style.lod, style.width, style.main, style.main_color, style.border_color,
                             style.texture_share));
    const LinePattern& pattern = category.pattern;
    choices.add(std::tie(category.caps, category.slope_correction, category.raster, category.raster_length,
                         category.sketch.amplitude, category.sketch.length, pattern.period, pattern.offset));
    choices.add(pattern.marks.size());
    for (const PatternMark& mark : pattern.marks)
        choices.add(std::tie(mark.begin, mark.end, mark.begin_width, mark.end_width));
}

}  // namespace

void validate(const DistanceFieldOptions& options) {
    if (options.categories.size() > most_network_categories)
        refuse("there are " + std::to_string(options.categories.size()) + " categories; at most " +
               std::to_string(most_network_categories) + " are drawn");
    for (const NetworkCategory& category : options.categories)
        validate(category, options);
    for (const uint32_t category : options.category_of)
        if (category >= options.categories.size() && category != no_network_category)
            throw Error(ErrorKind::input, "distance field: there is no category " + std::to_string(category));
    if (options.bits != 8 && options.bits != 32)
        refuse("fields have 8 or 32 bits, not " + std::to_string(options.bits));
    if (options.mend_intrusion && options.widths_at != LodPlace::vertex)
        refuse("mend_intrusion narrows lines node by node; it needs widths_at='vertex'");
    for (const NetworkRaster& raster : options.rasters) {
        const NetworkRaster& first = options.rasters.front();
        const auto texels = 4 * static_cast<size_t>(std::max(raster.width, 0)) *
                            static_cast<size_t>(std::max(raster.height, 0));
        if (texels == 0 || raster.texels.size() != texels || raster.width != first.width ||
            raster.height != first.height)
            refuse("rasters must all have one shape (rows, columns, 4)");
    }
    for (const std::vector<uint8_t>& drop_off : options.drop_offs)
        if (drop_off.size() != size_t{drop_off_side} * drop_off_side)
            refuse("a drop-off must have " + std::to_string(drop_off_side) + " x " +
                   std::to_string(drop_off_side) + " texels");
    validate(options.lod);
}

void DistanceFieldOptions::write(ChoiceBytes& choices) const {
    choices.add(categories.size());
    for (const NetworkCategory& category : categories)
        write_category(category, choices);
    choices.add(category_of);
    choices.add(std::tie(lod.source, lod.value, lod.near, lod.far, lod.space, lod.extent, lod.width,
                         lod.height, lod.texels));
    choices.add(
        std::tie(widths_at, bits, drop_off, blending, borders, keep_depth, mend_intrusion, mend_protrusion));
    choices.add(rasters.size());
    for (const NetworkRaster& raster : rasters)
        choices.add(std::tie(raster.width, raster.height, raster.texels));
    choices.add(drop_offs);
}

}  // namespace decalgl

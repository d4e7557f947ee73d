#include "decalgl/vector/stroke.h"

#include <algorithm>
#include <cmath>

#include "decalgl/core/error.h"

namespace decalgl {
namespace {

[[noreturn]] void refuse(const std::string& layer, const std::string& what) {
    throw Error(ErrorKind::style, "layer '" + layer + "': " + what);
}

void require_colors(const std::vector<uint8_t>& colors, size_t features, const std::string& layer) {
    if (colors.size() != 4 && colors.size() != 4 * features)
        refuse(layer, "needs one colour, or one for each of its " + std::to_string(features) + " features");
}

void require_places(const std::vector<uint32_t>& places, size_t features, size_t styles,
                    const std::string& layer) {
    if (styles == 0)
        refuse(layer, "has no style; leave one that is the default");
    if (!places.empty() && places.size() != features)
        refuse(layer, "needs one style, or one for each of its " + std::to_string(features) + " features");
    for (size_t i = 0; i < places.size(); ++i) {
        if (places[i] >= styles)
            refuse(layer, "feature " + std::to_string(i) + " has style " + std::to_string(places[i]) +
                              " of only " + std::to_string(styles));
    }
}

bool is_share(double value) {
    return value >= 0.0 && value <= 1.0;
}

void validate(const LinePattern& pattern, const std::string& layer) {
    if (pattern.period == 0.0 && pattern.marks.empty())
        return;
    if (!std::isfinite(pattern.period) || pattern.period <= 0.0 || !std::isfinite(pattern.offset))
        refuse(layer, "a pattern along a line needs a positive, finite period");
    if (pattern.marks.empty() || pattern.marks.size() > most_pattern_marks)
        refuse(layer,
               "a pattern along a line has from 1 to " + std::to_string(most_pattern_marks) + " marks");
    for (const PatternMark& mark : pattern.marks) {
        if (!(mark.begin >= 0.0 && mark.begin < mark.end && mark.end <= pattern.period) ||
            !is_share(mark.begin_width) || !is_share(mark.end_width))
            refuse(layer,
                   "a pattern's mark must begin before it ends, lie within its period, and have widths from "
                   "0 to 1");
    }
}

void validate(const std::vector<ColorBand>& bands, const std::string& layer) {
    if (bands.empty())
        return;
    if (bands.size() > most_color_bands)
        refuse(layer, "a line has at most " + std::to_string(most_color_bands) + " colours across");
    double previous = 0.0;
    for (const ColorBand& band : bands) {
        if (!(band.reach > previous && band.reach <= 1.0))
            refuse(layer, "colours across a line must reach farther one by one, up to 1");
        previous = band.reach;
    }
    if (previous != 1.0)
        refuse(layer, "the last colour across a line must reach to 1");
}

bool same(const LinePattern& a, const LinePattern& b) {
    return a.period == b.period && a.offset == b.offset && a.units == b.units &&
           std::equal(a.marks.begin(), a.marks.end(), b.marks.begin(), b.marks.end(),
                      [](const PatternMark& p, const PatternMark& q) {
                          return p.begin == q.begin && p.end == q.end && p.begin_width == q.begin_width &&
                                 p.end_width == q.end_width;
                      });
}

void validate(const WidthLimits& limits, const std::string& layer) {
    for (const double least : {limits.least_px, limits.least_metres})
        if (!std::isfinite(least) || least < 0.0)
            refuse(layer, "the least width must be 0 or more");
    if (!(limits.least_px <= limits.most_px && limits.least_metres <= limits.most_metres))
        refuse(layer, "the least width must not be above the most");
}

}  // namespace

bool operator==(const WidthLimits& a, const WidthLimits& b) {
    return a.least_px == b.least_px && a.most_px == b.most_px && a.least_metres == b.least_metres &&
           a.most_metres == b.most_metres;
}

bool WidthLimits::any() const {
    return !(*this == WidthLimits{});
}

bool operator==(const StrokeStyle& a, const StrokeStyle& b) {
    return a.corner == b.corner && a.cap == b.cap && a.miter_limit == b.miter_limit &&
           a.slope_correction == b.slope_correction && same(a.pattern, b.pattern) &&
           std::equal(a.bands.begin(), a.bands.end(), b.bands.begin(), b.bands.end(),
                      [](const ColorBand& p, const ColorBand& q) {
                          return p.reach == q.reach && p.color == q.color;
                      });
}

void validate(const Stroke& stroke, size_t features, const std::string& layer) {
    if (stroke.empty())
        return;
    require_colors(stroke.colors, features, layer);
    if (stroke.widths.size() != 1 && stroke.widths.size() != features)
        refuse(layer, "needs one width, or one for each of its " + std::to_string(features) + " features");
    for (size_t i = 0; i < stroke.widths.size(); ++i) {
        if (!std::isfinite(stroke.widths[i]) || stroke.widths[i] < 0.0)
            refuse(layer, "feature " + std::to_string(i) + " has width " + std::to_string(stroke.widths[i]) +
                              "; widths are lengths, 0 or more");
    }
    validate(stroke.limits, layer);
    if (!stroke.margins.empty() && stroke.margins.size() != features)
        refuse(layer, "needs no margins of widths, or one for each of its " + std::to_string(features) +
                          " features");
    for (const double margin : stroke.margins)
        if (!std::isfinite(margin) || margin < 0.0)
            refuse(layer, "the margin of a width must be a length");
    if (!std::isfinite(stroke.widest) || stroke.widest < 0.0)
        refuse(layer, "the widest that a stroke may become must be a length");
    require_places(stroke.style_of, features, stroke.styles.size(), layer);
    for (const StrokeStyle& style : stroke.styles) {
        if (!(style.miter_limit >= 1.0 && style.miter_limit <= 180.0))
            refuse(layer, "a miter limit is an angle from 1 to 180 degrees");
        validate(style.pattern, layer);
        if (style.pattern.units == WidthUnits::pixels && !stroke.follows_view())
            refuse(layer, "a pattern in pixels needs a width on the screen");
        validate(style.bands, layer);
    }
}

void validate(const Fill& fill, size_t features, const std::string& layer) {
    if (fill.empty())
        return;
    require_colors(fill.colors, features, layer);
    require_places(fill.hatch_of, features, fill.hatches.size(), layer);
    for (const Hatch& hatch : fill.hatches) {
        if (!std::isfinite(hatch.spacing) || !std::isfinite(hatch.width) || !std::isfinite(hatch.angle) ||
            hatch.spacing < 0.0 || hatch.width < 0.0)
            refuse(layer, "a hatch needs a finite spacing, width and angle; lengths are 0 or more");
    }
}

}  // namespace decalgl

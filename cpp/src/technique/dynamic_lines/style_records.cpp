#include "technique/dynamic_lines/style_records.h"

#include <cmath>
#include <cstring>

namespace decalgl {
namespace {

uint32_t packed(const uint8_t* color) {
    uint32_t word = 0;
    std::memcpy(&word, color, 4);
    return word;
}

float half(double width) {
    return static_cast<float>(0.5 * width);
}

uint32_t side_of(OutlineMode mode) {
    switch (mode) {
        case OutlineMode::inset:
            return INSIDE_ONLY;
        case OutlineMode::offset:
            return OUTSIDE_ONLY;
        case OutlineMode::normal:
            break;
    }
    return 0U;
}

bool has_side(const LineStyle& style) {
    return (style.kind & (INSIDE_ONLY | OUTSIDE_ONLY)) != 0;
}

// The colour of a band under the alpha of its feature.
uint32_t band_color(uint32_t band, uint32_t own) {
    const uint32_t alpha = ((band >> 24) * (own >> 24) + 127) / 255;
    return (band & 0xFFFFFFU) | alpha << 24;
}

}  // namespace

int first_octave(const LineLattice& lattice) {
    constexpr int reach_bits = 30;  // of the lattice: its reach is half the terrain and more
    constexpr int pixel_bits = 6;
    return pixel_bits - reach_bits - static_cast<int>(std::lrint(std::log2(lattice.quantum)));
}

StyleRecords::StyleRecords(const LineLattice& lattice)
    : patterns(1, PatternTexel{}),  // no pattern is the first
      longest_pixel_(std::exp2(-first_octave(lattice))) {}

std::vector<LineStyle> StyleRecords::of(const DecalView& view) {
    const Stroke& stroke = view.stroke();
    const StrokeStyle& style = view.style();
    LineStyle record{};
    record.kind = static_cast<uint32_t>(style.corner) | static_cast<uint32_t>(style.cap) << CAP_SHIFT |
                  (stroke.units == WidthUnits::metres ? IN_METRES : 0U) |
                  (stroke.limits.any() ? HAS_LIMITS : 0U) | side_of(view.cut()) |
                  static_cast<uint32_t>(std::lrint(256.0 * style.miter_limit)) << MITER_SHIFT;
    record.own_color = packed(view.color());
    record.color = record.own_color;
    const double share = has_side(record) ? 2.0 : 1.0;  // of a stroke that is cut, half is the whole width
    record.margin = half(share * stroke.margin(view.feature()));
    record.least_px = half(share * stroke.limits.least_px);
    record.most_px = half(share * stroke.limits.most_px);
    record.least_metres = half(share * stroke.limits.least_metres);
    record.most_metres = half(share * stroke.limits.most_metres);
    record.reach = 1.0F;
    record.pattern = pattern_of(style.pattern);
    set_width(record, stroke.width(view.feature()));
    if (style.bands.empty())
        return {record};
    std::vector<LineStyle> records;
    for (size_t band = style.bands.size(); band-- > 0;) {
        records.push_back(record);
        records.back().kind |= static_cast<uint32_t>(band) << BAND_SHIFT;
        records.back().reach = static_cast<float>(style.bands[band].reach);
        records.back().band_color = packed(style.bands[band].color.data());
        // With one band, too: it takes the place of the feature's colour.
        records.back().kind |= IS_BAND;
        set_color(records.back(), view.color());
    }
    return records;
}

uint32_t StyleRecords::pattern_of(const LinePattern& pattern) {
    if (pattern.period <= 0.0)
        return NO_PATTERN;
    const auto [known, is_new] = places_.emplace(&pattern, static_cast<uint32_t>(patterns.size()));
    if (!is_new)
        return known->second;
    const bool on_ground = pattern.units == WidthUnits::metres;
    patterns.push_back({static_cast<float>(pattern.marks.size()),
                        static_cast<float>(pattern.offset / pattern.period), on_ground ? 1.0F : 0.0F,
                        static_cast<float>(pattern.period * (on_ground ? 1.0 : longest_pixel_))});
    for (const PatternMark& mark : pattern.marks)
        patterns.push_back({static_cast<float>(mark.begin / pattern.period),
                            static_cast<float>(mark.end / pattern.period),
                            static_cast<float>(mark.begin_width), static_cast<float>(mark.end_width)});
    return known->second;
}

double arc_length(const LineStyle& style, Span<const PatternTexel> patterns) {
    return style.pattern == NO_PATTERN ? 0.0 : static_cast<double>(patterns[style.pattern][3]);
}

void set_color(LineStyle& style, const uint8_t* color) {
    style.own_color = packed(color);
    style.color =
        (style.kind & IS_BAND) != 0 ? band_color(style.band_color, style.own_color) : style.own_color;
}

void set_width(LineStyle& style, double width) {
    style.half_width = (has_side(style) ? static_cast<float>(width) : half(width)) - style.margin;
}

double width_of(const LineStyle& style) {
    const double whole = static_cast<double>(style.half_width) + static_cast<double>(style.margin);
    return has_side(style) ? whole : 2.0 * whole;
}

}  // namespace decalgl

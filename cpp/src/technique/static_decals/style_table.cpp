#include "technique/static_decals/style_table.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "technique/ground_lengths.h"

namespace decalgl {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double shortest_steady_edge = 256.0;  // units of words
constexpr double cosine_slack = 0.01;

uint32_t bits_of(double value) {
    const auto narrow = static_cast<float>(value);
    uint32_t bits = 0;
    std::memcpy(&bits, &narrow, sizeof bits);
    return bits;
}

StyleTexel floats(double x, double y, double z, double w) {
    return {bits_of(x), bits_of(y), bits_of(z), bits_of(w)};
}

bool is_joined(const StrokeStyle& style) {
    return style.corner != Corner::round || style.cap != Cap::round || style.pattern.period > 0.0;
}

// A turn by 180 degrees less the angle between two segments.
double miter_turn(const StrokeStyle& style) {
    return -std::cos(style.miter_limit * pi / 180.0);
}

uint32_t flags_of(const StrokeStyle& style) {
    uint32_t flags = 0;
    if (is_joined(style))
        flags |= STYLE_JOINED;
    if (style.corner != Corner::round)
        flags |= style.corner == Corner::miter ? STYLE_MITER : STYLE_BEVEL;
    if (style.cap == Cap::square)
        flags |= STYLE_SQUARE;
    if (style.pattern.period > 0.0)
        flags |= STYLE_PATTERN;
    if (!style.bands.empty())
        flags |= STYLE_BANDS;
    if (style.slope_correction != SlopeCorrection::none)
        flags |= style.slope_correction == SlopeCorrection::tangent ? STYLE_TANGENT : STYLE_THOENY;
    return flags;
}

double fraction(double value) {
    return value - std::floor(value);
}

// Where a set of lines is: `x`, `y` is a step across them of one spacing's length, over the spacing's square.
std::array<StyleTexel, 2> hatch_set(double x, double y, const BucketGrid& grid) {
    const double phase = fraction(x * grid.left() + y * grid.bottom());
    return {floats(x * grid.quantum, y * grid.quantum, phase, 0.0),
            floats(fraction(x * grid.bucket_size), fraction(y * grid.bucket_size), 0.0, 0.0)};
}

}  // namespace

double DecalShape::reach_at_turn(double cosine) const {
    const bool mitred = corner == Corner::miter && cosine >= miter_turn;
    return mitred ? half_width / std::sqrt(0.5 * (1.0 + cosine)) : half_width;
}

double DecalShape::longest_reach() const {
    return std::max(
        {double{half_width}, reach_at_turn(miter_turn), cap == Cap::square ? 1.5 * half_width : 0.0});
}

// Where words are in units of many quanta, or edges are short, rounding may turn an edge any way; so may a slope.
double DecalShape::reach_near(LatticePoint a, LatticePoint b, LatticePoint c) const {
    if (corner != Corner::miter)
        return half_width;
    if (is_tangent)
        return longest_reach();
    const auto dx = static_cast<double>(b.x - a.x), dy = static_cast<double>(b.y - a.y);
    const auto ex = static_cast<double>(c.x - b.x), ey = static_cast<double>(c.y - b.y);
    const double before = std::hypot(dx, dy), after = std::hypot(ex, ey);
    if (std::min(before, after) < std::ldexp(shortest_steady_edge, scale))
        return longest_reach();
    const double cosine = (dx * ex + dy * ey) / (before * after);
    return cosine < miter_turn - cosine_slack ? half_width
                                              : reach_at_turn(std::max(cosine - cosine_slack, miter_turn));
}

StyleTable::StyleTable(const TechniqueInput& input, const BucketGrid& grid) : input_(&input), grid_(&grid) {
    texels_.push_back({});
    for (const Layer& layer : input.layers) {
        LayerRecords records;
        records.strokes = add_strokes(layer.stroke);
        records.casings = add_strokes(layer.casing);
        if (!layer.fill.empty())
            for (const Hatch& hatch : layer.fill.hatches)
                records.hatches.push_back(add_hatch(hatch));
        layers_.push_back(std::move(records));
    }
}

std::vector<uint32_t> StyleTable::add_strokes(const Stroke& stroke) {
    std::vector<uint32_t> records;
    if (stroke.empty())
        return records;
    for (const StrokeStyle& style : stroke.styles)
        records.push_back(add_stroke(style));
    if (stroke.widest > 0.0)
        flags_ |= STYLE_WIDENED;
    return records;
}

uint32_t StyleTable::add_stroke(const StrokeStyle& style) {
    const uint32_t flags = flags_of(style);
    if (flags == 0)
        return 0;
    flags_ |= flags;
    const auto first = static_cast<uint32_t>(texels_.size());
    const LinePattern& pattern = style.pattern;
    const double periods = pattern.period > 0.0 ? grid_->quantum / pattern.period : 0.0;
    texels_.push_back({flags, bits_of(miter_turn(style)), bits_of(periods),
                       static_cast<uint32_t>(pattern.marks.size() | style.bands.size() << BANDS_SHIFT)});
    for (const PatternMark& mark : pattern.marks)
        texels_.push_back(
            floats(mark.begin / pattern.period, mark.end / pattern.period, mark.begin_width, mark.end_width));
    for (const ColorBand& band : style.bands) {
        uint32_t color = 0;
        std::memcpy(&color, band.color.data(), sizeof color);
        texels_.push_back({bits_of(band.reach), color, 0, 0});
    }
    return first;
}

uint32_t StyleTable::add_hatch(const Hatch& hatch) {
    if (hatch.spacing <= 0.0)
        return 0;
    flags_ |= STYLE_HATCH;
    const auto first = static_cast<uint32_t>(texels_.size());
    texels_.push_back({STYLE_HATCH, bits_of(0.5 * hatch.width / hatch.spacing), hatch.crossed ? 2U : 1U, 0});
    const double x = std::cos(hatch.angle * pi / 180.0) / hatch.spacing;
    const double y = std::sin(hatch.angle * pi / 180.0) / hatch.spacing;
    for (const StyleTexel& texel : hatch_set(-y, x, *grid_))
        texels_.push_back(texel);
    if (hatch.crossed)
        for (const StyleTexel& texel : hatch_set(x, y, *grid_))
            texels_.push_back(texel);
    return first;
}

DecalShape StyleTable::shape_of(const Decal& slot) const {
    DecalShape shape;
    const DecalView seen = view(slot);
    shape.is_clip = slot.role == DecalRole::clip;
    shape.is_offset = shape.is_clip && seen.layer->outline_mode == OutlineMode::offset;
    shape.is_stroke = slot.is_stroke();
    if (!shape.is_stroke)
        return shape;
    shape.is_clipped = seen.cut() != OutlineMode::normal;
    const StrokeStyle& style = seen.style();
    shape.half_width = static_cast<float>(seen.widest_half_width() / grid_->quantum);
    shape.corner = style.corner;
    shape.cap = style.cap;
    shape.is_joined = is_joined(style);
    shape.miter_turn = miter_turn(style);
    shape.is_tangent = style.slope_correction == SlopeCorrection::tangent;
    shape.follows_ground = follows_ground(style);
    if (style.pattern.period > 0.0) {
        shape.periods_per_quantum = grid_->quantum / style.pattern.period;
        shape.first_period = style.pattern.offset / style.pattern.period;
    }
    shape.scale = static_cast<int8_t>(line_scale(static_cast<float>(shape.longest_reach())));
    shape.covers_cells = style.pattern.period == 0.0 && style.bands.empty() &&
                         style.slope_correction == SlopeCorrection::none && seen.stroke().widest == 0.0;
    return shape;
}

uint32_t StyleTable::record_of(const Decal& slot) const {
    const DecalView seen = view(slot);
    const LayerRecords& records = layers_[slot.feature.layer - input_->first_layer];
    if (slot.role == DecalRole::fill)
        return records.hatches[seen.layer->fill.hatch(seen.feature())];
    if (!slot.is_stroke())
        return 0;
    return (slot.role == DecalRole::casing ? records.casings
                                           : records.strokes)[seen.stroke().style(seen.feature())];
}

uint32_t StyleTable::kind_of(const Decal& slot, const DecalShape& shape) const {
    return record_of(slot) << SCALE_BITS | static_cast<uint32_t>(shape.scale);
}

std::vector<Decal> slots_of(const TechniqueInput& input) {
    const std::vector<Decal> decals = decals_of(input.layers, input.first_layer, Hidden::kept);
    std::vector<Decal> slots;
    slots.reserve(decals.size());
    for (size_t i = decals.size(); i-- > 0;) {
        const DecalView seen{&input.layers[decals[i].feature.layer - input.first_layer], decals[i]};
        if (seen.cut() != OutlineMode::normal)
            slots.push_back({decals[i].feature, DecalRole::clip});
        slots.push_back(decals[i]);
    }
    return slots;
}

}  // namespace decalgl

#include "technique/dynamic_lines/prepared_lines.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/growing_array.h"
#include "decalgl/core/error.h"
#include "technique/dynamic_lines/line_writer.h"

namespace decalgl {
namespace {

[[noreturn]] void refuse(const Layer& layer, const std::string& what) {
    throw Error(ErrorKind::unsupported, "layer '" + layer.name + "': technique 'dynamic' " + what);
}

void require_drawable(const Layer& layer) {
    if (!layer.fill.empty())
        refuse(layer, "draws lines and outlines, but no fills; give technique='static', or color='none'");
    for (const Stroke* stroke : {&layer.stroke, &layer.casing}) {
        for (const StrokeStyle& style : stroke->styles) {
            if (style.slope_correction != SlopeCorrection::none)
                refuse(layer,
                       "knows no slope_correction, as its widths are those on the screen; leave it out");
        }
    }
}

// What the features of each layer share, for those that edits add.
std::shared_ptr<const LineTemplates> templates_of(const TechniqueInput& input, StyleRecords& records) {
    auto templates = std::make_shared<LineTemplates>();
    for (uint32_t i = 0; i < input.layers.size(); ++i) {
        const Layer& layer = input.layers[i];
        LineTemplate& known = (*templates)[input.first_layer + i];
        known.features = static_cast<uint32_t>(layer.features.feature_count());
        const auto records_of = [&](DecalRole role) {
            const DecalView view{&layer, {{input.first_layer + i, 0}, role}};
            return view.stroke().empty() || known.features == 0 ? std::vector<LineStyle>() : records.of(view);
        };
        known.casing = records_of(DecalRole::casing);
        known.stroke = records_of(DecalRole::stroke);
    }
    return templates;
}

bool looks_alike(const LineStyle& a, const LineStyle& b) {
    return std::memcmp(&a, &b, sizeof(LineStyle)) == 0;
}

}  // namespace

bool differ_in_color_alone(const PreparedLines& a, const PreparedLines& b) {
    const auto in_black = [](LineStyle style) {
        style.color = style.color >> 24 != 0 ? 0xFF000000U : 0;
        style.own_color = style.band_color = 0;
        return style;
    };
    return std::equal(
        a.styles.begin(), a.styles.end(), b.styles.begin(), b.styles.end(),
        [&](const LineStyle& x, const LineStyle& y) { return looks_alike(in_black(x), in_black(y)); });
}

LinePurpose purpose_of(const LineStyle& style, uint32_t slot, Span<const PatternTexel> patterns) {
    return {slot, arc_length(style, patterns), (style.kind & (INSIDE_ONLY | OUTSIDE_ONLY)) != 0};
}

std::unique_ptr<PreparedLines> prepare_lines(const TechniqueInput& input, Progress& progress) {
    auto prepared = std::make_unique<PreparedLines>();
    for (const Layer& layer : input.layers)
        require_drawable(layer);
    if (const auto* options = dynamic_cast<const DynamicOptions*>(input.layers[0].technique.options.get())) {
        prepared->method = options->method;
        prepared->width_rule = options->width_rule;
        prepared->cell = options->cell;
    }
    prepared->lattice = LineLattice::over(input.bounds);
    const std::vector<Decal> decals = decals_of(input.layers, input.first_layer, Hidden::kept);
    StyleRecords records(prepared->lattice);
    std::vector<Decal> slots;
    std::vector<LineStyle> styles;
    LineWriter writer(prepared->lattice, input.memory);
    for (size_t i = 0; i < decals.size(); ++i) {
        const DecalView view{&input.layers[decals[i].feature.layer - input.first_layer], decals[i]};
        for (const LineStyle& style : records.of(view)) {
            writer.add(view.layer->features, view.feature(),
                       purpose_of(style, static_cast<uint32_t>(slots.size()), records.patterns));
            slots.push_back(decals[i]);
            styles.push_back(style);
        }
        if (i % 4096 == 0)
            progress.report(static_cast<double>(i) / static_cast<double>(decals.size()));
    }
    prepared->templates = templates_of(input, records);
    prepared->segments = writer.segments;
    const auto keep = [&](auto& values) {
        using Value = typename std::decay_t<decltype(values)>::value_type;
        return charged(SharedArray<Value>(std::move(values)), input.memory, "dynamic: prepared");
    };
    prepared->vertices = keep(writer.vertices);
    prepared->lines = keep(writer.lines);
    prepared->styles = keep(styles);
    prepared->slots = keep(slots);
    prepared->patterns = keep(records.patterns);
    prepared->summarise();
    progress.report(1.0);
    return prepared;
}

void PreparedLines::summarise() {
    summary = {};
    const LineStyle* first = nullptr;
    for (const LineStyle& style : styles) {
        const uint32_t alpha = style.color >> 24;
        const bool is_styled = style.pattern != NO_PATTERN || (style.kind & IS_BAND) != 0;
        summary.has_arcs |= is_styled;
        if (alpha == 0) {
            summary.has_hidden = true;
            continue;
        }
        summary.has_shown = true;
        summary.has_translucency |= alpha != 255;
        summary.is_styled |= is_styled;
        summary.has_sides |= (style.kind & (INSIDE_ONLY | OUTSIDE_ONLY)) != 0;
        summary.is_joined |= (style.kind & (CORNER_MASK | 3U << CAP_SHIFT)) != 0;
        summary.has_limits |= (style.kind & (IN_METRES | HAS_LIMITS)) != 0;
        if (first == nullptr)
            first = &style;
        summary.has_one_look &= looks_alike(*first, style);
    }
    summary.is_joined |= summary.is_styled;  // joints have a place in the pattern
    summary.has_one_look &= !summary.has_hidden && !summary.is_styled && !summary.has_sides;
    summary.has_shown &= !lines.empty();
}

PreparedCounts PreparedLines::counts() const {
    return {slots.size(), segments, vertices.size(),
            vertices.size_bytes() + lines.size_bytes() + styles.size_bytes() + slots.size_bytes() +
                patterns.size_bytes(),
            0.5 * std::sqrt(2.0) * lattice.quantum};
}

}  // namespace decalgl

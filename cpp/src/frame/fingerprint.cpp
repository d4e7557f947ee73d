#include "frame/fingerprint.h"

#include "core/archive.h"

namespace decalgl {
namespace {

template <typename T>
void add(const std::vector<T>& values, DigestBuilder& builder) {
    builder.add(Span<const T>(values));
}

void add(const Stroke& stroke, DigestBuilder& builder) {
    add(stroke.colors, builder);
    add(stroke.widths, builder);
    add(stroke.style_of, builder);
    add(stroke.margins, builder);
    builder.add_value(stroke.widest);
    builder.add_value(stroke.units);
    for (const double limit : {stroke.limits.least_px, stroke.limits.most_px, stroke.limits.least_metres,
                               stroke.limits.most_metres})
        builder.add_value(limit);
    for (const StrokeStyle& style : stroke.styles) {
        builder.add_value(style.corner);
        builder.add_value(style.cap);
        builder.add_value(style.miter_limit);
        builder.add_value(style.slope_correction);
        builder.add_value(style.pattern.period);
        builder.add_value(style.pattern.offset);
        builder.add_value(style.pattern.units);
        for (const PatternMark& mark : style.pattern.marks)
            for (const double value : {mark.begin, mark.end, mark.begin_width, mark.end_width})
                builder.add_value(value);
        for (const ColorBand& band : style.bands) {
            builder.add_value(band.reach);
            builder.add_value(band.color);
        }
    }
}

void add(const Fill& fill, DigestBuilder& builder) {
    add(fill.colors, builder);
    add(fill.hatch_of, builder);
    for (const Hatch& hatch : fill.hatches) {
        for (const double value : {hatch.spacing, hatch.width, hatch.angle})
            builder.add_value(value);
        builder.add_value(hatch.crossed);
    }
}

Digest digest_of_look(const Relief& relief, const std::vector<Layer>& layers, unsigned threads) {
    DigestBuilder builder(threads);
    builder.add_value(relief.color);
    add(relief.ramp, builder);
    for (const double value :
         {relief.lowest, relief.highest, relief.azimuth, relief.altitude, relief.strength, relief.on_layers})
        builder.add_value(value);
    for (const Layer& layer : layers) {
        builder.add(Span<const char>(layer.name.data(), layer.name.size()));
        builder.add(Span<const char>(layer.technique.name.data(), layer.technique.name.size()));
        if (layer.technique.options) {
            ChoiceBytes choices;
            layer.technique.options->write(choices);
            add(choices.bytes(), builder);
        }
        builder.add_value(layer.features.kind);
        add(layer.fill, builder);
        add(layer.stroke, builder);
        add(layer.casing, builder);
        builder.add_value(layer.outline_mode);
        builder.add_value(layer.outline_order);
        add(layer.draw_order, builder);
    }
    return builder.finish();
}

}  // namespace

SceneFingerprint::SceneFingerprint(const Heightfield& terrain, const Relief& relief,
                                   const std::vector<Layer>& layers, unsigned threads)
    : terrain_(terrain), look_(digest_of_look(relief, layers, threads)) {
    for (const Layer& layer : layers)
        features_.push_back(layer.features);
}

Digest SceneFingerprint::digest(unsigned threads) const {
    if (known_)
        return *known_;
    DigestBuilder builder(threads);
    builder.add_value(archive_format);
    builder.add_value(look_);
    for (const int32_t count : {terrain_.rows(), terrain_.columns()})
        builder.add_value(count);
    for (const double value : {terrain_.x0(), terrain_.y0(), terrain_.dx(), terrain_.dy()})
        builder.add_value(value);
    builder.add(terrain_.heights().span());
    for (const Features& features : features_) {
        builder.add(features.coordinates);
        builder.add(features.part_offsets);
        builder.add(features.feature_offsets);
        builder.add(features.rows);
    }
    return builder.finish();
}

}  // namespace decalgl

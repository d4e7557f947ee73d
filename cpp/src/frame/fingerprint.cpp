#include "frame/fingerprint.h"

#include "core/archive.h"

namespace decalgl {
namespace {

template <typename T>
void add(const std::vector<T>& values, DigestBuilder& builder) {
    builder.add(Span<const T>(values));
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
        builder.add_value(layer.features.kind);
        add(layer.colors, builder);
        add(layer.widths, builder);
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

#include "app/honolulu.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "app/geotiff.h"
#include "app/gzip.h"
#include "app/isolines.h"
#include "app/topojson.h"
#include "decalgl/core/error.h"
#include "decalgl/geo/geographic_raster.h"

namespace decalgl {
namespace {

using Color = std::array<std::uint8_t, 4>;

struct Material {
    std::string_view name;
    std::uint32_t color;  // 0xRRGGBB, as in examples/honolulu.py
    bool narrow = false;  // drawn once more above the isolines
};

constexpr Material palette[] = {
    {"Ocean", 0xa3c7dc},          {"Lake", 0x86b8d6},       {"Stream", 0x2f7fb8, true},
    {"Canal", 0x2f7fb8, true},    {"Marsh", 0xb3cfb9},      {"Scrub", 0xb4c792},
    {"MixedForest", 0x93b27a},    {"Grassland", 0xd5dca6},  {"Grass", 0xc8dc9c},
    {"GolfCourse", 0xbbdb98},     {"Cemetery", 0xc5d3ac},   {"MixedCrop", 0xe3d99b},
    {"Sand", 0xf4e5b8},           {"Dirt", 0xd9c39a},       {"Gravel", 0xd0c5b2},
    {"Lava", 0xa08e82},           {"Town", 0xeee0cb},       {"Urban", 0xe6d6c3},
    {"Industrial", 0xd8c9c8},     {"Airport", 0xd9d3dd},    {"Asphalt", 0xc4bfc2},
    {"Railroad", 0x7d7670, true}, {"Road", 0xfffdf7, true}, {"Freeway", 0xe8924a, true},
};
constexpr std::uint32_t isoline_color = 0x7a5a36;
constexpr double isoline_step = 20.0;
constexpr int heavy_every = 5;
constexpr double exaggeration = 1.5;
constexpr std::size_t most_text = std::size_t{64} << 20;

Color opaque(std::uint32_t rgb) {
    return {static_cast<std::uint8_t>(rgb >> 16), static_cast<std::uint8_t>(rgb >> 8),
            static_cast<std::uint8_t>(rgb), 255};
}

const Material& material_named(const std::string& name, std::size_t feature) {
    const auto* found = std::find_if(std::begin(palette), std::end(palette),
                                     [&](const Material& material) { return material.name == name; });
    if (found == std::end(palette)) {
        throw Error(ErrorKind::style,
                    fmt::format("Feature {} of the land cover is of material '{}', which has no "
                                "colour. Use the file that comes with the examples.",
                                feature, name));
    }
    return *found;
}

/// Notes how long each step takes and says on whose behalf the program is busy.
class Steps {
public:
    Steps(const ProgressFn& progress, TimingLog& timings) : progress_(progress), timings_(timings) {}

    template <typename Work>
    auto operator()(const std::string& name, const Work& work) {
        Progress(progress_, name).report(0.0);
        const Stopwatch watch;
        auto result = work();
        timings_.add(name, watch.milliseconds());
        return result;
    }

private:
    const ProgressFn& progress_;
    TimingLog& timings_;
};

PolygonTable read_land_cover(const std::filesystem::path& path) {
    return parse_topojson(read_gzip(path, most_text), "landcover", "material", path.string());
}

Layer cover_layer(const PolygonTable& cover) {
    Layer layer;
    layer.name = "land cover";
    layer.features =
        Features::own(FeatureKind::polygons, cover.coordinates, cover.part_offsets, cover.feature_offsets);
    for (std::size_t feature = 0; feature < cover.values.size(); ++feature) {
        const Color color = opaque(material_named(cover.values[feature], feature).color);
        layer.fill.colors.insert(layer.fill.colors.end(), color.begin(), color.end());
    }
    return layer;
}

/// The narrow features of the land cover, which keep their rows.
Layer network_layer(const PolygonTable& cover) {
    Layer layer;
    layer.name = "streams and roads";
    std::vector<double> coordinates;
    std::vector<std::int64_t> part_offsets{0};
    std::vector<std::int64_t> feature_offsets{0};
    std::vector<std::int64_t> rows;
    for (std::size_t feature = 0; feature < cover.values.size(); ++feature) {
        const Material& material = material_named(cover.values[feature], feature);
        if (!material.narrow) {
            continue;
        }
        for (std::int64_t part = cover.feature_offsets[feature]; part < cover.feature_offsets[feature + 1];
             ++part) {
            const auto index = static_cast<std::size_t>(part);
            coordinates.insert(coordinates.end(), cover.coordinates.begin() + 2 * cover.part_offsets[index],
                               cover.coordinates.begin() + 2 * cover.part_offsets[index + 1]);
            part_offsets.push_back(static_cast<std::int64_t>(coordinates.size() / 2));
        }
        feature_offsets.push_back(static_cast<std::int64_t>(part_offsets.size()) - 1);
        rows.push_back(static_cast<std::int64_t>(feature));
        const Color color = opaque(material.color);
        layer.fill.colors.insert(layer.fill.colors.end(), color.begin(), color.end());
    }
    layer.features = Features::own(FeatureKind::polygons, std::move(coordinates), std::move(part_offsets),
                                   std::move(feature_offsets), std::move(rows));
    return layer;
}

/// Lines of equal height as one feature each.
Layer isoline_layer(const std::string& name, Polylines lines, std::uint8_t alpha, double width) {
    Layer layer;
    layer.name = name;
    std::vector<std::int64_t> features(lines.offsets.size());
    for (std::size_t line = 0; line < features.size(); ++line) {
        features[line] = static_cast<std::int64_t>(line);
    }
    layer.features = Features::own(FeatureKind::lines, std::move(lines.coordinates), std::move(lines.offsets),
                                   std::move(features));
    const Color color = opaque(isoline_color);
    layer.stroke.colors = {color[0], color[1], color[2], alpha};
    layer.stroke.widths = {width};
    return layer;
}

std::pair<Polylines, Polylines> isolines_of(const Heightfield& terrain) {
    float top = 0.0F;
    for (const float height : terrain.heights()) {
        top = height > top ? height : top;  // false for a missing sample
    }
    std::pair<Polylines, Polylines> common_and_heavy;
    for (int step = 1; step * isoline_step < top; ++step) {
        append_isolines(terrain, step * isoline_step,
                        step % heavy_every == 0 ? common_and_heavy.second : common_and_heavy.first);
    }
    return common_and_heavy;
}

}  // namespace

Scene build_honolulu(const std::filesystem::path& folder, const ProgressFn& progress, TimingLog& timings) {
    Steps step(progress, timings);
    const GeographicRaster raster = step("read terrain", [&] { return read_geotiff(folder / "dem.tif"); });
    const LocalPlane plane = plane_around(raster);
    Scene scene;
    scene.terrain = step("warp terrain", [&] { return warp_to_plane(raster, plane); });
    scene.exaggeration = exaggeration;
    scene.relief.strength = 0.6;
    scene.relief.on_layers = 0.55;

    PolygonTable cover =
        step("read land cover", [&] { return read_land_cover(folder / "landcover.topojson.gz"); });
    step("project land cover", [&] {
        plane.forward(cover.coordinates, cover.coordinates);
        return true;
    });
    auto [common, heavy] = step("derive isolines", [&] { return isolines_of(scene.terrain); });

    scene.layers.push_back(cover_layer(cover));
    scene.layers.push_back(isoline_layer("isolines 20 m", std::move(common), 128, 3.0));
    scene.layers.push_back(isoline_layer("isolines 100 m", std::move(heavy), 191, 7.0));
    scene.layers.push_back(network_layer(cover));
    return scene;
}

Camera honolulu_camera() {
    return Camera::look_at({-7000.0, -6500.0, 2500.0}, {-1600.0, 900.0, -330.0}, 38.0);
}

}  // namespace decalgl

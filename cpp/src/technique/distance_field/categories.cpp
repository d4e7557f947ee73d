#include "technique/distance_field/categories.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <tuple>

#include "decalgl/core/error.h"
#include "technique/distance_field/network_layout.h"

namespace decalgl::network {
namespace {

constexpr double most_margin = 8.0;
constexpr int band_rows = 256;

std::array<float, 4> color_of(const uint8_t* color) {
    return {color[0] / 255.0F, color[1] / 255.0F, color[2] / 255.0F, color[3] / 255.0F};
}

std::array<uint8_t, 4> bytes_of(const Stroke& stroke, size_t feature) {
    const uint8_t* color = stroke.color(feature);
    return {color[0], color[1], color[2], color[3]};
}

bool is_drawn(const Stroke& stroke, size_t feature) {
    return !stroke.empty() && stroke.color(feature)[3] > 0 && stroke.width(feature) > 0.0;
}

// Bands across a line, as a raster of one column.
NetworkRaster raster_of(const std::vector<ColorBand>& bands) {
    NetworkRaster raster{1, band_rows, {}};
    size_t band = 0;
    for (int row = 0; row < band_rows; ++row) {
        while (band + 1 < bands.size() && (row + 0.5) / band_rows > bands[band].reach)
            ++band;
        raster.texels.insert(raster.texels.end(), bands[band].color.begin(), bands[band].color.end());
    }
    return raster;
}

void require_round(const Layer& layer, const StrokeStyle& style) {
    if (style.corner != Corner::round)
        throw Error(ErrorKind::unsupported,
                    "layer '" + layer.name +
                        "': distance fields have round corners, since a segment knows no neighbour; use "
                        "corner 'round', or technique 'static'");
}

class ByLook {
public:
    explicit ByLook(CategoryTable& table) : table_(&table) {}

    void add(const Layer& layer, uint32_t index, uint32_t first_slot) {
        for (size_t rank = 0; rank < layer.features.feature_count(); ++rank) {
            const size_t feature = layer.feature_at(rank);
            if (!is_drawn(layer.stroke, feature) && !is_drawn(layer.casing, feature))
                continue;
            table_->slots[first_slot + feature].category = category_of(layer, index, feature);
        }
    }

private:
    using Key = std::tuple<uint32_t, std::array<uint8_t, 4>, double, std::array<uint8_t, 4>, double, size_t>;

    uint32_t category_of(const Layer& layer, uint32_t index, size_t feature) {
        Key key{index, {}, 0.0, {}, 0.0, layer.stroke.style(feature)};
        if (is_drawn(layer.stroke, feature)) {
            std::get<1>(key) = bytes_of(layer.stroke, feature);
            std::get<2>(key) = layer.stroke.width(feature);
        }
        if (is_drawn(layer.casing, feature)) {
            std::get<3>(key) = bytes_of(layer.casing, feature);
            std::get<4>(key) = layer.casing.width(feature);
        }
        const auto [entry, is_new] = known_.try_emplace(key, uint32_t(table_->categories.size()));
        if (is_new)
            add_category(layer, key);
        return entry->second;
    }

    void add_category(const Layer& layer, const Key& key) {
        if (table_->categories.size() == most_network_categories)
            throw Error(ErrorKind::style,
                        "layer '" + layer.name + "': its features have more than " +
                            std::to_string(most_network_categories) +
                            " different looks, and each takes a distance field; name categories with "
                            "DistanceField(category=...), or use technique 'static'");
        const StrokeStyle& style = layer.stroke.styles[std::get<5>(key)];
        require_round(layer, style);
        NetworkStyle look;
        const double core = std::get<2>(key);
        look.width = std::max(core, std::get<4>(key));
        look.main = core / look.width;
        look.main_color = color_of(std::get<1>(key).data());
        look.border_color = color_of(std::get<3>(key).data());
        NetworkCategory category;
        category.name = layer.name;
        category.caps.fill(static_cast<int>(style.cap == Cap::round    ? CapShape::round
                                            : style.cap == Cap::square ? CapShape::square
                                                                       : CapShape::butt));
        category.slope_correction = style.slope_correction;
        category.pattern = style.pattern;
        if (!style.bands.empty()) {
            category.raster = static_cast<int>(table_->rasters.size());
            table_->rasters.push_back(raster_of(style.bands));
            look.texture_share = 1.0;
        }
        category.styles = {look};
        table_->categories.push_back(std::move(category));
    }

    CategoryTable* table_;
    std::map<Key, uint32_t> known_;
};

void take_categories(Span<const Layer> layers, const DistanceFieldOptions& options, CategoryTable& table) {
    table.rasters = options.rasters;
    if (options.category_of.size() != table.slots.size())
        throw Error(ErrorKind::input, "a network needs a category for each of its " +
                                          std::to_string(table.slots.size()) + " features, but there are " +
                                          std::to_string(options.category_of.size()));
    std::vector<uint32_t> features(options.categories.size(), 0);
    size_t slot = 0;
    for (const Layer& layer : layers)
        for (size_t f = 0; f < layer.features.feature_count(); ++f, ++slot) {
            const uint32_t category = options.category_of[slot];
            if (category == no_network_category || !is_drawn(layer.stroke, f))
                continue;
            table.slots[slot].category = category;
            ++features[category];
        }
    // Categories without features take no field.
    std::vector<uint32_t> places(options.categories.size(), no_network_category);
    for (size_t i = 0; i < options.categories.size(); ++i) {
        if (features[i] == 0 || !(widest_half_width(options.categories[i]) > 0.0))
            continue;
        places[i] = static_cast<uint32_t>(table.categories.size());
        table.categories.push_back(options.categories[i]);
    }
    for (Slot& each : table.slots)
        if (each.shows())
            each.category = places[each.category];
}

// Of features of one category as they are drawn, of categories from bottom to top.
void set_order(Span<const Layer> layers, CategoryTable& table) {
    std::vector<uint32_t>& slots = table.ordered;
    uint32_t first = 0;
    for (const Layer& layer : layers) {
        for (size_t rank = 0; rank < layer.features.feature_count(); ++rank)
            slots.push_back(first + static_cast<uint32_t>(layer.feature_at(rank)));
        first += static_cast<uint32_t>(layer.features.feature_count());
    }
    std::stable_sort(slots.begin(), slots.end(), [&](uint32_t a, uint32_t b) {
        return table.slots[a].category < table.slots[b].category;
    });
    for (size_t i = 0; i < slots.size(); ++i)
        table.slots[slots[i]].order = static_cast<uint32_t>(i + 1);
}

StyleTexel texel(double a, double b, double c, double d) {
    return {static_cast<float>(a), static_cast<float>(b), static_cast<float>(c), static_cast<float>(d)};
}

// In fields whose widths are those of the nodes, a pixel's margin counts more where lines are narrower.
double margin_scale(const NetworkCategory& category, LodPlace place) {
    double narrowest = widest_half_width(category);
    for (const NetworkStyle& style : category.styles)
        if (style.width > 0.0)
            narrowest = std::min(narrowest, 0.5 * style.width);
    const double ratio = narrowest > 0.0 ? widest_half_width(category) / narrowest : 1.0;
    return place == LodPlace::vertex ? std::min(most_margin, ratio) : 1.0;
}

void write_texels(const DistanceFieldOptions& options, CategoryTable& table) {
    std::vector<StyleTexel> rest;
    const size_t headers = table.categories.size() * CATEGORY_TEXELS;
    const auto next = [&] { return static_cast<double>(headers + rest.size()); };
    for (const NetworkCategory& category : table.categories) {
        const double reach = widest_half_width(category);
        table.reach = std::max(table.reach, reach);
        table.lengths = table.lengths || category.pattern.period > 0.0 || category.raster >= 0 ||
                        category.sketch.amplitude > 0.0;
        table.slopes = table.slopes || category.slope_correction != SlopeCorrection::none;
        table.texels.push_back(texel(next(), static_cast<double>(category.styles.size()), reach,
                                     margin_scale(category, options.widths_at)));
        const auto& caps = category.caps;
        table.texels.push_back(texel(caps[0], caps[1], caps[2], caps[3]));
        for (const NetworkStyle& style : category.styles) {
            rest.push_back(texel(style.lod, 0.5 * style.width, style.main, style.texture_share));
            rest.push_back(style.main_color);
            rest.push_back(style.border_color);
        }
        const LinePattern& pattern = category.pattern;
        table.texels.push_back(
            texel(next(), static_cast<double>(pattern.marks.size()), pattern.period, pattern.offset));
        for (const PatternMark& mark : pattern.marks)
            rest.push_back(texel(mark.begin, mark.end, mark.begin_width, mark.end_width));
        table.texels.push_back(texel(category.raster, category.raster_length,
                                     static_cast<double>(category.slope_correction), category.sketch.length));
        table.texels.push_back(texel(category.sketch.amplitude, reach > 0.0 ? 1.0 : 0.0, 0.0, 0.0));
    }
    table.texels.insert(table.texels.end(), rest.begin(), rest.end());
    table.shapes = table.texels;
    for (size_t i = 0; i < table.categories.size(); ++i) {
        const StyleTexel& header = table.texels[i * CATEGORY_TEXELS];
        for (size_t tuple = 0; tuple < table.categories[i].styles.size(); ++tuple) {
            const size_t first = static_cast<size_t>(header[0]) + tuple * TUPLE_TEXELS;
            table.shapes[first + 1] = table.shapes[first + 2] = {};
        }
    }
}

}  // namespace

bool same_fields(const CategoryTable& a, const CategoryTable& b) {
    return a.shapes == b.shapes && std::equal(a.slots.begin(), a.slots.end(), b.slots.begin(), b.slots.end(),
                                              [](Slot x, Slot y) { return x.category == y.category; });
}

double widest_half_width(const NetworkCategory& category) {
    double widest = 0.0;
    for (const NetworkStyle& style : category.styles)
        widest = std::max(widest, 0.5 * style.width);
    return widest;
}

NetworkStyle style_at(const NetworkCategory& category, double lod) {
    const std::vector<NetworkStyle>& styles = category.styles;
    size_t upper = 0;
    while (upper < styles.size() && styles[upper].lod < lod)
        ++upper;
    if (upper == 0)
        return styles.front();
    if (upper == styles.size())
        return styles.back();
    const NetworkStyle &a = styles[upper - 1], &b = styles[upper];
    const double share = (lod - a.lod) / (b.lod - a.lod);
    const auto mix = [&](double x, double y) { return x + share * (y - x); };
    NetworkStyle mixed = a;
    mixed.lod = lod;
    mixed.width = mix(a.width, b.width);
    mixed.main = mix(a.main, b.main);
    for (size_t i = 0; i < 4; ++i) {
        mixed.main_color[i] = static_cast<float>(mix(a.main_color[i], b.main_color[i]));
        mixed.border_color[i] = static_cast<float>(mix(a.border_color[i], b.border_color[i]));
    }
    return mixed;
}

CategoryTable make_categories(Span<const Layer> layers, const DistanceFieldOptions& options) {
    CategoryTable table;
    size_t features = 0;
    for (const Layer& layer : layers) {
        if (layer.features.kind != FeatureKind::lines)
            throw Error(ErrorKind::unsupported, "layer '" + layer.name +
                                                    "': distance fields draw networks of lines; draw "
                                                    "polygons with technique 'static'");
        features += layer.features.feature_count();
    }
    table.slots.resize(features);
    if (!options.categories.empty()) {
        take_categories(layers, options, table);
    } else {
        ByLook by_look(table);
        uint32_t first = 0;
        for (uint32_t i = 0; i < layers.size(); ++i) {
            by_look.add(layers[i], i, first);
            first += static_cast<uint32_t>(layers[i].features.feature_count());
        }
    }
    set_order(layers, table);
    write_texels(options, table);
    return table;
}

}  // namespace decalgl::network

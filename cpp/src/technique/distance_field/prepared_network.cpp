#include "technique/distance_field/prepared_network.h"

#include <algorithm>
#include <utility>

#include "decalgl/core/error.h"
#include "technique/distance_field/mends.h"
#include "technique/plain_styles.h"

namespace decalgl::network {
namespace {

constexpr const char* account_name = "distance_field: network";

std::shared_ptr<const DistanceFieldOptions> options_of(const TechniqueChoice& choice) {
    if (!choice.options)
        return std::make_shared<DistanceFieldOptions>();
    auto options = std::dynamic_pointer_cast<const DistanceFieldOptions>(choice.options);
    if (!options)
        throw Error(ErrorKind::input, "technique 'distance_field' was given the options of another one");
    validate(*options);
    return options;
}

std::vector<FeatureReference> references_of(const TechniqueInput& input) {
    std::vector<FeatureReference> references;
    for (uint32_t i = 0; i < input.layers.size(); ++i)
        for (uint32_t f = 0; f < input.layers[i].features.feature_count(); ++f)
            references.push_back({input.first_layer + i, f});
    return references;
}

// Only rows and looks of a layer: its geometry is in the network.
Layer without_geometry(const Layer& layer) {
    Layer bare = layer;
    const Span<const int64_t> rows = layer.features.rows;
    bare.features = Features::own(layer.features.kind, {}, {0}, std::vector<int64_t>(rows.size() + 1, 0),
                                  {rows.begin(), rows.end()});
    bare.technique = {};
    return bare;
}

void mend(Network& network, const CategoryTable& table, const DistanceFieldOptions& options) {
    forget_mends(network);
    if (options.mend_protrusion)
        cut_caps(network, table);
    if (options.mend_intrusion)
        keep_apart(network, table);
}

bool mends(const DistanceFieldOptions& options) {
    return options.mend_intrusion || options.mend_protrusion;
}

std::shared_ptr<const MemoryCharge> charge_for(const Network& network, const MemoryAccount& memory) {
    return std::make_shared<const MemoryCharge>(memory, account_name, network.bytes());
}

void set_look(const DecalLook& look, size_t features, Stroke& stroke) {
    if (!look.colors.empty() && !stroke.empty())
        stroke.colors = look.colors;
    if (look.widths.empty() || stroke.empty())
        return;
    stroke.widths = look.widths;
    // One width may stand beside many colours, and the other way round.
    if (stroke.widths.size() == 1 && features > 1)
        stroke.widths.assign(features, look.widths[0]);
}

DecalLook look_of(const Stroke& stroke, size_t features) {
    DecalLook look;
    for (size_t f = 0; !stroke.empty() && f < features; ++f) {
        look.colors.insert(look.colors.end(), stroke.color(f), stroke.color(f) + 4);
        look.widths.push_back(stroke.width(f));
    }
    return look;
}

}  // namespace

std::unique_ptr<PreparedNetwork> prepare_network(const TechniqueInput& input, Progress& progress) {
    auto prepared = std::make_unique<PreparedNetwork>();
    prepared->options = options_of(input.layers[0].technique);
    prepared->table = make_categories(input.layers, *prepared->options);
    prepared->first_layer = input.first_layer;
    prepared->positions = input.positions;
    prepared->references = references_of(input);
    prepared->input_segments = segments_of(input.layers);
    prepared->reach = prepared->table.reach;
    auto network = std::make_shared<Network>(build_network(input, prepared->reach, progress));
    prepared->charge = charge_for(*network, input.memory);
    prepared->ranges =
        std::make_shared<HeightRanges>(*input.terrain, input.threads, input.memory, "distance_field: ground");
    set_heights(*network, *prepared->ranges, prepared->reach);
    mend(*network, prepared->table, *prepared->options);
    prepared->network = std::move(network);
    for (const Layer& layer : input.layers)
        prepared->layers.push_back(without_geometry(layer));
    progress.report(1.0);
    return prepared;
}

PreparedCounts PreparedNetwork::counts() const {
    PreparedCounts counts;
    counts.features = references.size();
    counts.segments = input_segments;
    counts.pieces = network->segments.size();
    counts.bytes =
        network->bytes() + table.slots.size() * sizeof(Slot) + table.texels.size() * sizeof(StyleTexel);
    counts.quantum = network->lattice.quantum;
    return counts;
}

bool PreparedNetwork::shows_anything() const {
    return !network->segments.empty() && table.reach > 0.0 &&
           std::any_of(table.slots.begin(), table.slots.end(), [](Slot slot) { return slot.shows(); });
}

void PreparedNetwork::save(ArchiveWriter&, const std::string&) const {
    throw Error(ErrorKind::unsupported,
                "technique 'distance_field' is not kept on disk; preparing it takes little more than reading "
                "it would");
}

LayerLook PreparedNetwork::look_of(uint32_t layer, size_t features) const {
    const Layer& own = layers[layer - first_layer];
    LayerLook look;
    look.layer = layer;
    look.stroke = network::look_of(own.stroke, features);
    look.casing = network::look_of(own.casing, features);
    return look;
}

std::shared_ptr<const Prepared> PreparedNetwork::restyled(Span<const LayerLook> looks,
                                                          const MemoryAccount& memory) const {
    auto changed = std::make_shared<PreparedNetwork>(*this);
    for (const LayerLook& look : looks) {
        Layer& layer = changed->layers[look.layer - first_layer];
        const size_t features = layer.features.feature_count();
        set_look(look.stroke, features, layer.stroke);
        set_look(look.casing, features, layer.casing);
        if (!look.draw_order.empty())
            layer.draw_order = look.draw_order;
        if (look.options)
            changed->options = options_of({"distance_field", look.options});
    }
    changed->table = make_categories(changed->layers, *changed->options);
    const bool is_wider = changed->table.reach > reach;
    if (!is_wider && !mends(*options) && !mends(*changed->options))
        return changed;
    const auto copy_charge = charge_for(*network, memory);
    auto copy = std::make_shared<Network>(*network);
    if (is_wider) {
        changed->reach = changed->table.reach;
        set_heights(*copy, *ranges, changed->reach);
    }
    mend(*copy, changed->table, *changed->options);
    changed->network = std::move(copy);
    changed->charge = copy_charge;
    return changed;
}

std::shared_ptr<const Prepared> PreparedNetwork::edited(const LayerEdit&, const MemoryAccount&) const {
    throw Error(ErrorKind::unsupported,
                "technique 'distance_field' stays as it was prepared; prepare the scene anew, which takes "
                "little, or use technique 'static'");
}

}  // namespace decalgl::network

// A prepared network: nodes, segments and the categories of its features.
//
// A restyle shares the nodes and segments, and has another table of categories; where mends depend on that, the
// network is copied.
#pragma once

#include <memory>
#include <vector>

#include "technique/distance_field/categories.h"
#include "technique/distance_field/network.h"
#include "terrain/height_ranges.h"

namespace decalgl::network {

class PreparedNetwork : public Prepared {
public:
    PreparedCounts counts() const override;
    FeatureReference feature(uint32_t id) const override { return references[table.ordered[id]]; }
    // As wide as at the level of detail that the options' value or texture on the map says; by others, as wide as
    // at any.
    std::vector<FeatureReference> query(const SeenPoint& point) const override;
    void save(ArchiveWriter& archive, const std::string& prefix) const override;
    bool shows_anything() const override;
    LayerLook look_of(uint32_t layer, size_t features) const override;
    std::shared_ptr<const Prepared> restyled(Span<const LayerLook> looks,
                                             const MemoryAccount& memory) const override;
    std::shared_ptr<const Prepared> edited(const LayerEdit& edit, const MemoryAccount& memory) const override;

    std::shared_ptr<const Network> network;
    std::shared_ptr<const HeightRanges> ranges;
    std::shared_ptr<const DistanceFieldOptions> options;
    CategoryTable table;
    std::vector<Layer> layers;  // without their geometry
    uint32_t first_layer = 0;
    std::vector<FeatureReference> references;  // of slots
    double reach = 0.0;                        // that boxes and bounds allow for
    PositionGrid positions;
    uint64_t input_segments = 0;
    std::shared_ptr<const MemoryCharge> charge;  // of the network
};

std::unique_ptr<PreparedNetwork> prepare_network(const TechniqueInput& input, Progress& progress);

}  // namespace decalgl::network

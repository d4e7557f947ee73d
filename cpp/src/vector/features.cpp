#include "decalgl/vector/features.h"

#include <cmath>
#include <utility>

#include "decalgl/core/error.h"

namespace decalgl {
namespace {

constexpr double farthest = 1e9;  // metres

struct OwnedArrays {
    std::vector<double> coordinates;
    std::vector<int64_t> part_offsets;
    std::vector<int64_t> feature_offsets;
    std::vector<int64_t> rows;
    std::vector<float> slants;
};

void require_offsets(Span<const int64_t> offsets, size_t total, const char* what, const std::string& layer) {
    const bool has_ends =
        !offsets.empty() && offsets[0] == 0 && offsets[offsets.size() - 1] == static_cast<int64_t>(total);
    bool rises = has_ends;
    for (size_t i = 1; rises && i < offsets.size(); ++i)
        rises = offsets[i - 1] <= offsets[i];
    if (!rises)
        throw Error(ErrorKind::input, "layer '" + layer + "': " + what +
                                          " must start at 0, never fall and end at " + std::to_string(total) +
                                          "; rebuild the offsets from the part sizes");
}

}  // namespace

Features Features::own(FeatureKind kind, std::vector<double> coordinates, std::vector<int64_t> part_offsets,
                       std::vector<int64_t> feature_offsets, std::vector<int64_t> rows,
                       std::vector<float> slants) {
    auto arrays = std::make_shared<OwnedArrays>();
    arrays->coordinates = std::move(coordinates);
    arrays->part_offsets = std::move(part_offsets);
    arrays->feature_offsets = std::move(feature_offsets);
    arrays->rows = std::move(rows);
    arrays->slants = std::move(slants);
    if (arrays->rows.empty() && !arrays->feature_offsets.empty()) {
        arrays->rows.resize(arrays->feature_offsets.size() - 1);
        for (size_t row = 0; row < arrays->rows.size(); ++row)
            arrays->rows[row] = static_cast<int64_t>(row);
    }

    Features features;
    features.kind = kind;
    features.coordinates = {arrays->coordinates.data(), arrays->coordinates.size()};
    features.part_offsets = {arrays->part_offsets.data(), arrays->part_offsets.size()};
    features.feature_offsets = {arrays->feature_offsets.data(), arrays->feature_offsets.size()};
    features.rows = {arrays->rows.data(), arrays->rows.size()};
    features.slants = {arrays->slants.data(), arrays->slants.size()};
    features.storage = std::move(arrays);
    return features;
}

void validate(const Features& features, const std::string& layer_name) {
    require_offsets(features.part_offsets, features.vertex_count(), "part offsets", layer_name);
    require_offsets(features.feature_offsets, features.part_count(), "feature offsets", layer_name);
    if (features.rows.size() + 1 != features.feature_offsets.size())
        throw Error(ErrorKind::input, "layer '" + layer_name + "': needs one row number for each feature");
    for (size_t i = 0; i < features.coordinates.size(); ++i) {
        if (!(std::abs(features.coordinates[i]) <= farthest))
            throw Error(ErrorKind::input, "layer '" + layer_name + "': vertex " + std::to_string(i / 2) +
                                              " is not finite or farther than 1e9 m from the origin; remove "
                                              "or repair it");
    }
}

}  // namespace decalgl

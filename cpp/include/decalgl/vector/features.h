// Features: polygons or lines as flat arrays, the only form in which vector data enters the core.
//
//   feature_offsets   feature f owns parts feature_offsets[f] .. feature_offsets[f + 1]
//   part_offsets      part p owns vertices part_offsets[p] .. part_offsets[p + 1]
//   coordinates       x, y of each vertex, float64, in the scene's coordinate system
//   slants            of the edge that ends at each vertex, its length on the ground over that on the map, less than 0 where
//                     that vertex only tells where the ground bends; empty where nothing is measured along the ground
//
// A polygon's parts are all its rings, exterior and interior alike and closed implicitly: what is inside
// is decided by the even-odd rule over all of them. A line's parts are its polylines.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "decalgl/core/span.h"

namespace decalgl {

enum class FeatureKind { polygons, lines };

struct Features {
    FeatureKind kind = FeatureKind::polygons;
    Span<const double> coordinates;
    Span<const int64_t> part_offsets;
    Span<const int64_t> feature_offsets;
    Span<const int64_t> rows;  // the row of each feature in the user's data
    Span<const float> slants;

    // Keeps alive whatever the spans point into; several Features may share it.
    std::shared_ptr<const void> storage;

    // Takes the arrays over. `rows` may be empty: then feature f is row f.
    static Features own(FeatureKind kind, std::vector<double> coordinates, std::vector<int64_t> part_offsets,
                        std::vector<int64_t> feature_offsets, std::vector<int64_t> rows = {},
                        std::vector<float> slants = {});

    size_t feature_count() const { return rows.size(); }
    size_t part_count() const { return part_offsets.size() - 1; }
    size_t vertex_count() const { return coordinates.size() / 2; }

    // All vertices of a feature, part after part.
    Span<const double> vertices(size_t feature) const {
        const auto first = static_cast<size_t>(part_offsets[static_cast<size_t>(feature_offsets[feature])]);
        const auto last =
            static_cast<size_t>(part_offsets[static_cast<size_t>(feature_offsets[feature + 1])]);
        return coordinates.subspan(2 * first, 2 * (last - first));
    }

    Span<const double> part(size_t part_index) const {
        const auto first = static_cast<size_t>(part_offsets[part_index]);
        const auto last = static_cast<size_t>(part_offsets[part_index + 1]);
        return coordinates.subspan(2 * first, 2 * (last - first));
    }

    // None where there are none at all.
    Span<const float> slants_of(size_t part_index) const {
        if (slants.empty())
            return {};
        const auto first = static_cast<size_t>(part_offsets[part_index]);
        return slants.subspan(first, static_cast<size_t>(part_offsets[part_index + 1]) - first);
    }
};

// Throws Error(input) naming `layer_name` when offsets are not monotone or out of range, or a coordinate is
// not finite.
void validate(const Features& features, const std::string& layer_name);

}  // namespace decalgl

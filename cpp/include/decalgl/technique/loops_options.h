// How LOOPS is prepared: orders of removal, primitives of lines, and the parameters of its index.
//
// After Amiraghdam, Diehl and Pajarola, LOOPS: Locally Optimized Polygon Simplification, sections 4.3 to 4.5.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "decalgl/core/span.h"
#include "decalgl/technique/loops_detail.h"
#include "decalgl/vector/layer.h"

namespace decalgl {

// In which order an arc loses its vertices, and the length that each removal is off by.
enum class RemovalOrder : uint8_t { douglas_peucker, wang_mueller, visvalingam_whyatt, function };

struct Removal {
    uint32_t vertex;
    double error;
};

// An order of a user's own: x, y of an arc's vertices in metres, the ends included; gives all vertices but
// the two ends, the first to go first. Called by one thread at a time.
using RemovalFunction = std::function<std::vector<Removal>(Span<const double> coordinates)>;

// What lines are drawn by: refinement triangles, or the segments of all levels (LOCALIS). Fills are always triangles.
enum class LinePrimitives : uint8_t { triangles, segments };

// The index of section 4.5. Branching counts the children of a node, a square number, level by level.
struct LoopsBvh {
    std::vector<uint32_t> primary_branching;  // empty: chosen from the data
    uint32_t node_capacity = 45;              // primitives in a primary node that is not divided
    double largest_share =
        1.0;  // of its primitives that children may hold on average for a primary node to be divided
    std::vector<uint32_t> secondary_depths;  // by the level of the primary leaf; beyond the last: 0
    std::vector<uint32_t> secondary_branching;
    uint32_t coverage_depth = 2;
    double minimum_coverage =
        1.0;  // share of the nodes below that a primitive covers where it stays in a node
};

// Layers of equal options are prepared together; two functions are never equal.
struct LoopsOptions {
    RemovalOrder order = RemovalOrder::douglas_peucker;
    RemovalFunction function;
    LinePrimitives primitives = LinePrimitives::triangles;
    std::optional<LoopsBvh> bvh;  // none: cells, made anew for each view of what is active in it
};

// Throws Error(input) that names what is out of range.
void validate(const LoopsOptions& options);

// What a layer's TechniqueChoice carries: `detail` is what it begins with.
class LoopsChoice : public TechniqueOptions {
public:
    LoopsOptions options;
    LoopsDetail detail;

    bool equals(const TechniqueOptions& other) const override;
};

}  // namespace decalgl

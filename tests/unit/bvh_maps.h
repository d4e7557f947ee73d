// Maps for the tests of the BVH index, and what a point lies in by brute force.
#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "technique/static_bvh/complete_tree.h"
#include "technique/static_bvh/prepared_bvh.h"

namespace decalgl::bvh::maps {

constexpr Bounds test_bounds{1000.0, 2000.0, 1997.0, 2991.0};

using Part = std::vector<double>;
using Feature = std::vector<Part>;

inline Features features_of(FeatureKind kind, const std::vector<Feature>& all) {
    std::vector<double> coordinates;
    std::vector<int64_t> part_offsets{0};
    std::vector<int64_t> feature_offsets{0};
    for (const Feature& feature : all) {
        for (const Part& part : feature) {
            coordinates.insert(coordinates.end(), part.begin(), part.end());
            part_offsets.push_back(static_cast<int64_t>(coordinates.size() / 2));
        }
        feature_offsets.push_back(static_cast<int64_t>(part_offsets.size()) - 1);
    }
    return Features::own(kind, coordinates, part_offsets, feature_offsets);
}

inline Layer polygons(const std::vector<Feature>& all) {
    Layer layer;
    layer.name = "polygons";
    layer.features = features_of(FeatureKind::polygons, all);
    layer.fill.colors = {200, 100, 50, 255};
    return layer;
}

inline Layer lines(const std::vector<Feature>& all, std::vector<double> widths) {
    Layer layer;
    layer.name = "lines";
    layer.features = features_of(FeatureKind::lines, all);
    layer.stroke.colors = {20, 30, 40, 255};
    layer.stroke.widths = std::move(widths);
    return layer;
}

inline TechniqueInput input_of(const std::vector<Layer>& layers, const BvhOptions& options) {
    TechniqueInput input;
    input.layers = layers;
    input.bounds = test_bounds;
    input.positions = PositionGrid::around(test_bounds);
    input.bvh = options;
    return input;
}

inline std::unique_ptr<PreparedBvh> build(const std::vector<Layer>& layers, const BvhOptions& options = {},
                                          unsigned threads = 0) {
    TechniqueInput input = input_of(layers, options);
    input.threads = threads;
    Progress progress;
    return build_bvh(input, progress);
}

inline BvhOptions with_cells(int cells, int leaf_capacity = 8, int depth_limit = 8) {
    BvhOptions options;
    options.cells = cells;
    options.leaf_capacity = leaf_capacity;
    options.depth_limit = depth_limit;
    return options;
}

struct RandomMap {
    std::mt19937 engine;
    explicit RandomMap(unsigned seed) : engine(seed) {}

    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine);
    }

    // Vertices spread around a place in the bounds; with `snap` above 0 on multiples of it.
    Part part(int vertices, double size, double snap = 0.0) {
        const double x = between(test_bounds.min_x - 200, test_bounds.max_x + 200);
        const double y = between(test_bounds.min_y - 200, test_bounds.max_y + 200);
        return part_at(x, y, vertices, size, snap);
    }

    Part part_at(double x, double y, int vertices, double size, double snap = 0.0) {
        Part result;
        for (int i = 0; i < vertices; ++i)
            for (const double centre : {x, y}) {
                const double value = centre + between(-size, size);
                result.push_back(snap > 0.0 ? std::round(value / snap) * snap : value);
            }
        return result;
    }
};

struct Position {
    double x;
    double y;
};

// Near a vertex of a feature as a rule, often level with one, and inside the bounds.
inline Position near(const Feature& feature, RandomMap& random, double size) {
    const Part& part = feature[random.engine() % feature.size()];
    const size_t vertex = random.engine() % (part.size() / 2);
    const bool level = random.engine() % 4 == 0, upright = random.engine() % 4 == 0;
    return {std::clamp(part[2 * vertex] + (upright ? 0.0 : random.between(-size, size)), test_bounds.min_x,
                       test_bounds.max_x),
            std::clamp(part[2 * vertex + 1] + (level ? 0.0 : random.between(-size, size)), test_bounds.min_y,
                       test_bounds.max_y)};
}

// Even-odd over all rings, exactly, by a ray to the left of a lattice point.
inline bool inside(const Lattice& lattice, const Feature& feature, Position position) {
    const LatticePoint p = lattice.nearest(position.x, position.y);
    bool result = false;
    for (const Part& ring : feature) {
        const size_t count = ring.size() / 2;
        for (size_t i = 0; count > 2 && i < count; ++i) {
            const size_t j = (i + 1) % count;
            LatticePoint a = lattice.nearest(ring[2 * i], ring[2 * i + 1]);
            LatticePoint b = lattice.nearest(ring[2 * j], ring[2 * j + 1]);
            if ((a.y <= p.y) == (b.y <= p.y))
                continue;
            if (b.y < a.y)
                std::swap(a, b);
            const auto left = __extension__ __int128{p.x - a.x} * (int64_t{b.y} - a.y);
            const auto right = __extension__ __int128{p.y - a.y} * (int64_t{b.x} - a.x);
            result ^= left >= right;
        }
    }
    return result;
}

inline double distance_to(const Feature& feature, Position p) {
    double nearest = 1e300;
    for (const Part& line : feature) {
        for (size_t i = 0; i == 0 || i + 3 < line.size(); i += 2) {
            const size_t j = line.size() == 2 ? 0 : i + 2;
            const double dx = line[j] - line[i], dy = line[j + 1] - line[i + 1];
            const double length2 = dx * dx + dy * dy;
            const double along = (p.x - line[i]) * dx + (p.y - line[i + 1]) * dy;
            const double t = length2 > 0.0 ? std::clamp(along / length2, 0.0, 1.0) : 0.0;
            nearest = std::min(nearest, std::hypot(p.x - line[i] - t * dx, p.y - line[i + 1] - t * dy));
        }
    }
    return nearest;
}

inline std::vector<bool> found_at(const PreparedBvh& bvh, size_t features, Position p) {
    std::vector<bool> found(features, false);
    for (const FeatureReference& reference : bvh.query({p.x, p.y}))
        found[reference.feature] = true;
    return found;
}

// Boxes lie in their parents', and objects follow in draw order.
inline bool well_formed_cell(const PreparedBvh& bvh, const DecalGroup& group, uint32_t cell) {
    const CellStart start = group.cells[cell];
    const uint32_t objects = start.count, stored = stored_nodes(objects);
    bool good = start.node + stored <= group.nodes.size();
    for (uint32_t node = 2; node <= stored; ++node) {
        const LatticeBox& box = group.nodes[start.node + node - 1];
        good &= box.empty() || group.nodes[start.node + node / 2 - 1].holds(box);
    }
    const bool in_order =
        group.kind != GroupKind::strokes || bvh.options.segment_order == SegmentOrder::importance;
    uint32_t previous = 0;
    for (uint32_t i = start.object; i < start.object + objects; ++i) {
        const uint32_t slot = group.slot_of(group.object(i));
        const uint32_t rank = slot < group.styles.size() ? group.styles[slot].rank : 0;
        good &= slot < group.styles.size() && (!in_order || rank >= previous);
        previous = rank;
    }
    return good;
}

inline int64_t points_in(const LatticeBox& box) {
    return (int64_t{box.max_x} - box.min_x + 1) * (int64_t{box.max_y} - box.min_y + 1);
}

// Children share a node's points among them; leaves have their edges, and those their rows in the leaf.
inline bool well_formed_node(const QuadTreesOf<GrownArray>& quads, size_t node) {
    const QuadLink link = quads.links[node];
    const LatticeBox& box = quads.boxes[node];
    bool good = true;
    if (link.kind() == QUAD_INTERNAL) {
        int64_t points = 0;
        for (uint32_t child = link.first; child < link.first + 4; ++child) {
            good &= box.holds(quads.boxes[child]);
            points += points_in(quads.boxes[child]);
        }
        good &= points == points_in(box);
    } else if (link.kind() == QUAD_PARTIAL) {
        good &= link.count() > 0 && link.first + link.count() <= quads.edges.size();
        for (uint32_t i = link.first; i < link.first + link.count(); ++i) {
            const LeafEdge& edge = quads.edges[i];
            good &=
                box.min_y <= edge.first_row && edge.first_row < edge.end_row && edge.end_row - 1 <= box.max_y;
        }
    }
    return good;
}

inline size_t count_of_slots(const PreparedBvh& bvh) {
    size_t count = 0;
    for (const DecalGroup& group : bvh.groups)
        count += group.slots.size();
    return count;
}

inline void require_well_formed(const PreparedBvh& bvh) {
    for (const DecalGroup& group : bvh.groups) {
        bool good = true;
        for (uint32_t cell = 0; cell < group.grid.cell_count(); ++cell)
            good &= well_formed_cell(bvh, group, cell);
        for (size_t node = 0; node < group.quads.links.size(); ++node)
            good &= well_formed_node(group.quads, node);
        REQUIRE(good);
    }
}

inline void require_polygons_found(const std::vector<Feature>& all, const BvhOptions& options, double size,
                                   int samples) {
    const auto bvh = build({polygons(all)}, options);
    require_well_formed(*bvh);
    RandomMap random(5);
    for (int sample = 0; sample < samples; ++sample) {
        const Position p = near(all[static_cast<size_t>(sample) % all.size()], random, size);
        std::vector<bool> expected;
        for (const Feature& feature : all)
            expected.push_back(inside(bvh->lattice, feature, p));
        INFO(p.x << ", " << p.y);
        REQUIRE(found_at(*bvh, all.size(), p) == expected);
    }
}

}  // namespace decalgl::bvh::maps

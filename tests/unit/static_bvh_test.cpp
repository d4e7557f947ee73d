// The BVH index against brute force: polygons exactly, lattice point by lattice point, and lines to a
// quantum.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <random>

#include "error_kind.h"
#include "technique/static_bvh/complete_tree.h"
#include "technique/static_bvh/hilbert.h"
#include "technique/static_bvh/prepared_bvh.h"
#include "technique/static_bvh/quad_trees.h"
#include "technique/static_bvh/quad_walk.h"
#include "technique/static_bvh/stroke_outline.h"

using namespace decalgl;
using namespace decalgl::bvh;

namespace {

constexpr Bounds test_bounds{1000.0, 2000.0, 1997.0, 2991.0};

using Part = std::vector<double>;
using Feature = std::vector<Part>;

Features features_of(FeatureKind kind, const std::vector<Feature>& all) {
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

Layer polygons(const std::vector<Feature>& all) {
    Layer layer;
    layer.name = "polygons";
    layer.features = features_of(FeatureKind::polygons, all);
    layer.fill.colors = {200, 100, 50, 255};
    return layer;
}

Layer lines(const std::vector<Feature>& all, std::vector<double> widths) {
    Layer layer;
    layer.name = "lines";
    layer.features = features_of(FeatureKind::lines, all);
    layer.stroke.colors = {20, 30, 40, 255};
    layer.stroke.widths = std::move(widths);
    return layer;
}

TechniqueInput input_of(const std::vector<Layer>& layers, const BvhOptions& options) {
    TechniqueInput input;
    input.layers = layers;
    input.bounds = test_bounds;
    input.positions = PositionGrid::around(test_bounds);
    input.bvh = options;
    return input;
}

std::unique_ptr<PreparedBvh> build(const std::vector<Layer>& layers, const BvhOptions& options = {},
                                   unsigned threads = 0) {
    TechniqueInput input = input_of(layers, options);
    input.threads = threads;
    Progress progress;
    return build_bvh(input, progress);
}

BvhOptions with_cells(int cells, int leaf_capacity = 8, int depth_limit = 8) {
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
Position near(const Feature& feature, RandomMap& random, double size) {
    const Part& part = feature[random.engine() % feature.size()];
    const size_t vertex = random.engine() % (part.size() / 2);
    const bool level = random.engine() % 4 == 0, upright = random.engine() % 4 == 0;
    return {std::clamp(part[2 * vertex] + (upright ? 0.0 : random.between(-size, size)), test_bounds.min_x,
                       test_bounds.max_x),
            std::clamp(part[2 * vertex + 1] + (level ? 0.0 : random.between(-size, size)), test_bounds.min_y,
                       test_bounds.max_y)};
}

// Even-odd over all rings, exactly, by a ray to the left of a lattice point.
bool inside(const Lattice& lattice, const Feature& feature, Position position) {
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

double distance_to(const Feature& feature, Position p) {
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

std::vector<bool> found_at(const PreparedBvh& bvh, size_t features, Position p) {
    std::vector<bool> found(features, false);
    for (const FeatureReference& reference : bvh.query(p.x, p.y))
        found[reference.feature] = true;
    return found;
}

// Boxes lie in their parents', and objects follow in draw order.
bool well_formed_cell(const PreparedBvh& bvh, const DecalGroup& group, uint32_t cell) {
    const CellStart start = group.cells[cell];
    const uint32_t objects = group.objects_in(cell), stored = stored_nodes(objects);
    bool good = group.cells[cell + 1].node == start.node + stored;
    for (uint32_t node = 2; node <= stored; ++node) {
        const LatticeBox& box = group.nodes[start.node + node - 1];
        good &= box.empty() || group.nodes[start.node + node / 2 - 1].holds(box);
    }
    const bool in_order =
        group.kind != GroupKind::strokes || bvh.options.segment_order == SegmentOrder::importance;
    uint32_t previous = 0;
    for (uint32_t i = start.object; i < start.object + objects; ++i) {
        const uint32_t slot = group.slot_of(group.object(i));
        good &= slot < group.styles.size() && (!in_order || slot >= previous);
        previous = slot;
    }
    return good;
}

int64_t points_in(const LatticeBox& box) {
    return (int64_t{box.max_x} - box.min_x + 1) * (int64_t{box.max_y} - box.min_y + 1);
}

// Children share a node's points among them; leaves have their edges, and those their rows in the leaf.
bool well_formed_node(const QuadTrees& quads, size_t node) {
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

void require_well_formed(const PreparedBvh& bvh) {
    for (const DecalGroup& group : bvh.groups) {
        bool good = true;
        for (uint32_t cell = 0; cell < group.grid.cell_count(); ++cell)
            good &= well_formed_cell(bvh, group, cell);
        for (size_t node = 0; node < group.quads.links.size(); ++node)
            good &= well_formed_node(group.quads, node);
        REQUIRE(good);
    }
}

void require_polygons_found(const std::vector<Feature>& all, const BvhOptions& options, double size,
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

}  // namespace

TEST_CASE("rings of a BVH index agree with brute force at every lattice point", "[bvh]") {
    const double size = GENERATE(1e-5, 0.3, 100.0, 700.0);
    const double snap = GENERATE(0.0, 0.5);
    const BvhOptions options = GENERATE(with_cells(1), with_cells(37, 1, 5), with_cells(500, 8, 8));
    RandomMap random(static_cast<unsigned>(size * 10 + snap));
    std::vector<Feature> all;
    for (int i = 0; i < 25; ++i)
        all.push_back({random.part(3 + i % 9, size, snap)});
    require_polygons_found(all, options, size, 1500);
}

TEST_CASE("features of many rings are even-odd, wherever the rings lie", "[bvh]") {
    const BvhOptions options = GENERATE(with_cells(60, 8, 8), with_cells(300, 2, 16), with_cells(9, 8, 0));
    RandomMap random(17);
    std::vector<Feature> all;
    for (int i = 0; i < 12; ++i) {
        const double x = random.between(1100, 1900), y = random.between(2100, 2900);
        Feature feature;
        // Holes, rings beside and across the first one, one that repeats another, and ones without an area.
        for (int ring = 0; ring < 3 + i; ++ring)
            feature.push_back(random.part_at(x + random.between(-80, 80), y + random.between(-80, 80),
                                             3 + ring, 60.0, 0.25));
        feature.push_back(feature.front());
        feature.push_back({x, y, x + 5, y, x + 9, y});
        feature.push_back({x, y, x, y});
        all.push_back(feature);
    }
    require_polygons_found(all, options, 100.0, 3000);
}

TEST_CASE("nested squares alternate", "[bvh]") {
    Feature feature;
    for (int i = 0; i < 10; ++i) {
        const double inset = 20.0 * i;
        feature.push_back({1300 + inset, 2300 + inset, 1700 - inset, 2300 + inset, 1700 - inset, 2700 - inset,
                           1300 + inset, 2700 - inset});
    }
    const auto bvh = build({polygons({feature})});
    for (int i = 0; i < 10; ++i)
        CHECK(bvh->query(1310 + 20 * i, 2500).size() == (i % 2 == 0 ? 1 : 0));
}

TEST_CASE("a comb of level and upright edges", "[bvh]") {
    // Teeth on the quarter of a metre, so that edges run along the borders of nodes.
    Part comb;
    for (int tooth = 0; tooth < 200; ++tooth) {
        const double x = 1100 + 2 * tooth;
        for (const auto& [dx, y] :
             std::vector<std::pair<double, double>>{{0, 2100}, {0, 2500}, {1, 2500}, {1, 2100}})
            comb.insert(comb.end(), {x + dx, y});
    }
    comb.insert(comb.end(), {1600, 2100, 1600, 2050, 1100, 2050});
    require_polygons_found({{comb}}, GENERATE(with_cells(100, 4, 8), with_cells(500, 1, 12)), 3.0, 4000);
}

TEST_CASE("lines of a BVH index agree with brute force", "[bvh]") {
    const double width = GENERATE(0.01, 0.8, 7.0, 90.0, 5000.0);
    const double size = GENERATE(0.5, 60.0, 3000.0);
    BvhOptions options = with_cells(GENERATE(1, 100));
    options.segment_order = GENERATE(SegmentOrder::importance, SegmentOrder::hilbert);
    RandomMap random(static_cast<unsigned>(width * 100 + size));
    std::vector<Feature> all;
    for (int i = 0; i < 25; ++i)
        all.push_back({random.part(1 + i % 7, size)});
    const auto bvh = build({lines(all, {width})}, options);
    require_well_formed(*bvh);
    const double tolerance = 1.5 * bvh->counts().quantum;
    for (int sample = 0; sample < 800; ++sample) {
        const Position p = near(all[static_cast<size_t>(sample) % all.size()], random, width + size);
        const std::vector<bool> found = found_at(*bvh, all.size(), p);
        for (size_t i = 0; i < all.size(); ++i) {
            const double distance = distance_to(all[i], p);
            if (std::abs(distance - 0.5 * width) > tolerance)
                REQUIRE(found[i] == (distance < 0.5 * width));
        }
    }
}

TEST_CASE("what lies far beyond the map is cut, and the rest stays exact", "[bvh]") {
    const double far = GENERATE(2e3, 1e6, 1e9);
    RandomMap random(23);
    std::vector<Feature> rings, strokes;
    for (int i = 0; i < 20; ++i) {
        rings.push_back({random.part_at(1500, 2500, 3 + i, far)});
        strokes.push_back({random.part_at(1500, 2500, 2 + i, far)});
    }
    const auto bvh = build({polygons(rings), lines(strokes, {300.0})}, with_cells(20));
    for (int sample = 0; sample < 1500; ++sample) {
        const Position p{random.between(1000, 1997), random.between(2000, 2991)};
        std::vector<bool> in_rings(rings.size()), in_strokes(strokes.size());
        for (const FeatureReference& reference : bvh->query(p.x, p.y))
            (reference.layer == 0 ? in_rings : in_strokes)[reference.feature] = true;
        for (size_t i = 0; i < rings.size(); ++i) {
            // Cuts are rounded, and doubles that far out are no better.
            Feature closed = rings[i];
            closed[0].insert(closed[0].end(), {closed[0][0], closed[0][1]});
            if (distance_to(closed, p) > 1e-3)
                REQUIRE(in_rings[i] == [&] {
                    bool result = false;
                    const Part& ring = closed[0];
                    for (size_t k = 0; k + 3 < ring.size(); k += 2)
                        if ((ring[k + 1] <= p.y) != (ring[k + 3] <= p.y))
                            result ^= ring[k] + (p.y - ring[k + 1]) / (ring[k + 3] - ring[k + 1]) *
                                                    (ring[k + 2] - ring[k]) <=
                                      p.x;
                    return result;
                }());
            const double distance = distance_to(strokes[i], p);
            if (std::abs(distance - 150.0) > 1e-3)
                REQUIRE(in_strokes[i] == (distance < 150.0));
        }
    }
}

TEST_CASE("neighbours of a BVH index own each point once", "[bvh]") {
    RandomMap random(7);
    constexpr int side = 12;
    std::vector<Position> corners;
    for (int row = 0; row <= side; ++row)
        for (int column = 0; column <= side; ++column) {
            const bool rim = row == 0 || column == 0 || row == side || column == side;
            corners.push_back({900.0 + column * 100.0 + (rim ? 0.0 : random.between(-45, 45)),
                               1900.0 + row * 100.0 + (rim ? 0.0 : random.between(-45, 45))});
        }
    std::vector<Feature> all;
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column) {
            std::vector<int> turn{0, 1, side + 2, side + 1};
            if ((row + column) % 2 != 0)
                std::reverse(turn.begin(), turn.end());
            Part ring;
            for (const int k : turn) {
                const Position corner = corners[static_cast<size_t>(row * (side + 1) + column + k)];
                ring.insert(ring.end(), {corner.x, corner.y});
            }
            all.push_back({ring});
        }
    const auto bvh = build({polygons(all)}, with_cells(70, 1, 10));
    for (int sample = 0; sample < 100000; ++sample) {
        const Part& a = all[static_cast<size_t>(sample) % all.size()][0];
        const double t = random.between(0, 1), jitter = random.between(-1, 1) * bvh->lattice.quantum;
        const double x = std::clamp(a[0] + t * (a[2] - a[0]) + jitter, test_bounds.min_x, test_bounds.max_x);
        const double y = std::clamp(a[1] + t * (a[3] - a[1]), test_bounds.min_y, test_bounds.max_y);
        REQUIRE(bvh->query(x, y).size() == 1);
    }
}

TEST_CASE("a culling offset is the smallest subtree with the cell's part of the ring", "[bvh]") {
    RandomMap random(29);
    Part ring;
    for (int i = 0; i < 400; ++i) {
        const double angle = 2 * M_PI * i / 400, radius = random.between(300, 400);
        ring.insert(ring.end(), {1500 + radius * std::cos(angle), 2500 + radius * std::sin(angle)});
    }
    const auto bvh = build({polygons({{ring}})}, with_cells(50));
    const DecalGroup& group = bvh->groups.front();
    const QuadTrees& quads = group.quads;
    int below_root = 0;
    for (uint32_t cell = 0; cell < group.grid.cell_count(); ++cell) {
        const LatticeBox part = common(group.grid.cell_box(cell), quads.boxes[0]);
        for (uint32_t i = group.cells[cell].object; i < group.cells[cell + 1].object; ++i) {
            const uint32_t subtree = group.exteriors[i].subtree;
            below_root += subtree != 0;
            REQUIRE(quads.boxes[subtree].holds(part));
            const QuadLink link = quads.links[subtree];
            for (uint32_t child = link.first; link.kind() == QUAD_INTERNAL && child < link.first + 4; ++child)
                REQUIRE_FALSE(quads.boxes[child].holds(part));
        }
    }
    CHECK(below_root > 500);
}

TEST_CASE("leaves are inside, outside or partial, within their capacity", "[bvh]") {
    RandomMap random(31);
    Part ring;
    for (int i = 0; i < 3000; ++i) {
        const double angle = 2 * M_PI * i / 3000, radius = random.between(390, 400);
        ring.insert(ring.end(), {1500 + radius * std::cos(angle), 2500 + radius * std::sin(angle)});
    }
    const auto bvh = build({polygons({{ring}})}, with_cells(50, 6, 16));
    const DecalGroup& group = bvh->groups.front();
    size_t kinds[4] = {};
    for (size_t node = 0; node < group.quads.links.size(); ++node) {
        const QuadLink link = group.quads.links[node];
        ++kinds[link.kind()];
        if (link.kind() == QUAD_PARTIAL) {
            const auto own = std::count_if(group.quads.edges.begin() + link.first,
                                           group.quads.edges.begin() + link.first + link.count(),
                                           [](const LeafEdge& edge) { return edge.a != CLOSING_EDGE; });
            CHECK(own <= 6);
        } else if (link.kind() != QUAD_INTERNAL) {
            const LatticeBox& box = group.quads.boxes[node];
            for (int i = 0; i < 4; ++i) {
                const LatticePoint p{i % 2 ? box.max_x : box.min_x, i / 2 ? box.max_y : box.min_y};
                const Position at{bvh->lattice.left + p.x * bvh->lattice.quantum,
                                  bvh->lattice.bottom + p.y * bvh->lattice.quantum};
                REQUIRE(inside(bvh->lattice, {ring}, at) == (link.kind() == QUAD_INSIDE));
            }
        }
    }
    CHECK(std::all_of(kinds, kinds + 4, [](size_t count) { return count > 50; }));
    const auto shallow = build({polygons({{ring}})}, with_cells(50, 6, 2));
    CHECK(shallow->groups.front().quads.links.size() <= 1 + 4 + 16);
}

TEST_CASE("a BVH index is the same bytes on any number of threads", "[bvh]") {
    RandomMap random(11);
    std::vector<Feature> rings, parts;
    // One ring that several threads share, and many that they divide.
    Part giant;
    for (int i = 0; i < 60000; ++i) {
        const double angle = 2 * M_PI * i / 60000, radius = random.between(300, 450);
        giant.insert(giant.end(), {1500 + radius * std::cos(angle), 2500 + radius * std::sin(angle)});
    }
    rings.push_back({giant});
    for (int i = 0; i < 1000; ++i) {
        rings.push_back({random.part(30, 30.0), random.part(10, 10.0)});
        parts.push_back({random.part(60, 80.0)});
    }
    BvhOptions options;
    options.segment_order = GENERATE(SegmentOrder::importance, SegmentOrder::hilbert);
    const std::vector<Layer> layers{polygons(rings), lines(parts, {3.0})};
    const auto one = build(layers, options, 1), many = build(layers, options, 5);
    const auto same = [](const auto& a, const auto& b) {
        return a.size() == b.size() &&
               (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
    };
    for (size_t i = 0; i < 2; ++i) {
        const DecalGroup &a = one->groups[i], &b = many->groups[i];
        CHECK(same(a.cells, b.cells));
        CHECK(same(a.nodes, b.nodes));
        CHECK(same(a.vertices, b.vertices));
        CHECK(same(a.segments, b.segments));
        CHECK(same(a.exteriors, b.exteriors));
        CHECK(same(a.interiors, b.interiors));
        CHECK(same(a.quads.boxes, b.quads.boxes));
        CHECK(same(a.quads.links, b.quads.links));
        CHECK(same(a.quads.edges, b.quads.edges));
    }
}

TEST_CASE("groups follow the passes asked for, and slots the draw order", "[bvh]") {
    const Feature square{{1100, 2100, 1200, 2100, 1200, 2200, 1100, 2200}};
    Layer layer = polygons({square, square, square});
    layer.fill.colors = {1, 2, 3, 255, 4, 5, 6, 0, 7, 8, 9, 128};
    layer.draw_order = {2, 1, 0};
    const std::vector<Layer> layers{layer, polygons({square}), lines({{{1100, 2150, 1200, 2150}}}, {5.0})};
    BvhOptions options;
    options.passes = GENERATE(PassGrouping::layer, PassGrouping::kind);
    const auto bvh = build(layers, options);
    CHECK(bvh->groups.size() == (options.passes == PassGrouping::layer ? 3 : 2));
    std::vector<std::pair<uint32_t, uint32_t>> found;
    for (const FeatureReference& each : bvh->query(1150, 2150))
        found.emplace_back(each.layer, each.feature);
    CHECK(found == std::vector<std::pair<uint32_t, uint32_t>>{{2, 0}, {1, 0}, {0, 0}, {0, 2}});
    CHECK(bvh->query(5000, 2150).empty());
}

TEST_CASE("a cancelled, an excessive and an impossible BVH index", "[bvh]") {
    RandomMap random(3);
    std::vector<Feature> rings, wide;
    for (int i = 0; i < 2000; ++i) {
        rings.push_back({random.part(50, 50.0)});
        wide.push_back({{1000, 2000, 1990, 2000, 1990, 2990 - 0.01 * i}});
    }
    const auto kind_of_build = [](const std::vector<Layer>& layers, const BvhOptions& options, bool goes_on) {
        TechniqueInput input = input_of(layers, options);
        Progress progress([goes_on](std::string_view, double) { return goes_on; }, "layers");
        return test::kind_of([&] { build_bvh(input, progress); });
    };
    CHECK(kind_of_build({polygons(rings)}, {}, false) == ErrorKind::cancelled);
    CHECK(kind_of_build({polygons(wide)}, with_cells(4096), true) == ErrorKind::memory);
    Layer glass = lines({{{1100, 2100, 1200, 2200}}}, {5.0});
    glass.stroke.colors = {1, 2, 3, 128};
    BvhOptions options;
    options.segment_order = SegmentOrder::hilbert;
    CHECK(kind_of_build({glass}, options, true) == ErrorKind::unsupported);
    options.composition = Composition::nearest;
    CHECK(build({glass}, options)->query(1150, 2150).size() == 1);
}

TEST_CASE("widened segments reach the cells that they overlap", "[bvh]") {
    RandomMap random(41);
    const DecalGrid grid = DecalGrid::over({0, 0, 9999, 7999}, 20);
    int wrong = 0;
    for (int i = 0; i < 100; ++i) {
        const auto place = [&] { return static_cast<int32_t>(random.between(-2000, 12000)); };
        const LatticePoint a{place(), place()}, b{place(), place()};
        const double half_width = random.between(1, i % 2 ? 50 : 1500);
        std::vector<bool> reached(grid.cell_count(), false);
        const StrokeOutline outline = round_outline(a, b, half_width);
        grid.for_each_cell(outline.corners, outline.box,
                           [&](uint32_t cell) { reached[cell] = true; });
        const Feature line{{double(a.x), double(a.y), double(b.x), double(b.y)}};
        for (uint32_t cell = 0; cell < grid.cell_count(); ++cell) {
            const LatticeBox box = grid.cell_box(cell);
            double nearest = 1e300;
            for (int k = 0; k < 40 * 40; ++k)
                nearest = std::min(
                    nearest, distance_to(line, {box.min_x + (box.max_x - box.min_x) * (k % 40) / 39.0,
                                                box.min_y + (box.max_y - box.min_y) * (k / 40) / 39.0}));
            // A stroke is round at its ends, its outline square.
            const double corner = half_width * std::sqrt(2.0) + 3.0;
            wrong += (nearest <= half_width && !reached[cell]) || (nearest > corner + 15.0 && reached[cell]);
        }
    }
    CHECK(wrong == 0);
}

TEST_CASE("complete trees and the curve", "[bvh]") {
    CHECK(stored_nodes(0) == 0);
    CHECK(stored_nodes(1) == 1);
    CHECK(stored_nodes(5) == 7 + 5);
    CHECK(next_right(1) == 0);
    CHECK(next_right(4) == 5);
    CHECK(next_right(11) == 3);
    CHECK(next_right(15) == 0);
    // A step along the curve is a step to a neighbour.
    std::vector<Position> way(256);
    for (uint32_t x = 0; x < 16; ++x)
        for (uint32_t y = 0; y < 16; ++y)
            way[hilbert_place(x << 12, y << 12) >> 24] = {double(x), double(y)};
    for (size_t i = 1; i < way.size(); ++i)
        CHECK(std::abs(way[i].x - way[i - 1].x) + std::abs(way[i].y - way[i - 1].y) == 1.0);
}

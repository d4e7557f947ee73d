// The BVH index as a whole: groups, threads, limits; and its trees.
#include <cstring>

#include "bvh_maps.h"
#include "error_kind.h"
#include "technique/static_bvh/hilbert.h"

using namespace decalgl;
using namespace decalgl::bvh;
using namespace decalgl::bvh::maps;

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
        for (const FeatureReference& reference : bvh->query({p.x, p.y}))
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
    for (const FeatureReference& each : bvh->query({1150, 2150}))
        found.emplace_back(each.layer, each.feature);
    CHECK(found == std::vector<std::pair<uint32_t, uint32_t>>{{2, 0}, {1, 0}, {0, 0}, {0, 2}});
    CHECK(bvh->query({5000, 2150}).empty());
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
    CHECK(build({glass}, options)->query({1150, 2150}).size() == 1);
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

TEST_CASE("fills and outlines go together where they must, and a feature is found once", "[bvh]") {
    const Feature square{{1100, 2100, 1200, 2100, 1200, 2200, 1100, 2200}};
    Layer layer = polygons({square, square});
    layer.stroke.colors = {7, 8, 9, 255};
    layer.stroke.widths = {10.0};
    layer.outline_mode = GENERATE(OutlineMode::normal, OutlineMode::inset);
    layer.outline_order = GENERATE(OutlineOrder::layer, OutlineOrder::feature);
    const auto bvh = build({layer});
    const bool together =
        layer.outline_mode == OutlineMode::inset || layer.outline_order == OutlineOrder::feature;
    CHECK(bvh->groups.size() == (together ? 1 : 2));
    CHECK((bvh->groups[0].kind == GroupKind::both) == together);
    CHECK(bvh->counts().features == 2);
    CHECK(bvh->counts().segments == 8);
    CHECK(count_of_slots(*bvh) == 4);
    const std::vector<FeatureReference> found = bvh->query({1102, 2150});
    CHECK(found == std::vector<FeatureReference>{{0, 1}, {0, 0}});
}

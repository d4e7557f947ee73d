// Fills of the BVH index against brute force, lattice point by lattice point.
#include "bvh_maps.h"

using namespace decalgl;
using namespace decalgl::bvh;
using namespace decalgl::bvh::maps;

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
        CHECK(bvh->query({1310.0 + 20 * i, 2500}).size() == (i % 2 == 0 ? 1 : 0));
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
        REQUIRE(bvh->query({x, y}).size() == 1);
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
    const QuadTreesOf<GrownArray>& quads = group.quads;
    int below_root = 0;
    for (uint32_t cell = 0; cell < group.grid.cell_count(); ++cell) {
        const LatticeBox part = common(group.grid.cell_box(cell), quads.boxes[0]);
        const CellStart start = group.cells[cell];
        for (uint32_t i = start.object; i < start.object + start.count; ++i) {
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

TEST_CASE("hatches of a BVH index lie where their definition says", "[bvh]") {
    const bool crossed = GENERATE(false, true);
    const double angle = GENERATE(0.0, 30.0, 90.0, -45.0);
    const Hatch hatch{7.0, 2.0, angle, crossed};
    Layer layer = polygons({{{1000, 2000, 1990, 2000, 1990, 2990, 1000, 2990}}});
    layer.fill.hatches = {hatch};
    const auto bvh = build({layer}, with_cells(20));
    const double a = angle * M_PI / 180.0;
    const auto apart = [&](double w) { return std::abs(w - 7.0 * std::round(w / 7.0)); };
    RandomMap random(2);
    for (int sample = 0; sample < 5000; ++sample) {
        const Position p{random.between(1001, 1989), random.between(2001, 2989)};
        double nearest = apart(-p.x * std::sin(a) + p.y * std::cos(a));
        if (crossed)
            nearest = std::min(nearest, apart(p.x * std::cos(a) + p.y * std::sin(a)));
        if (std::abs(nearest - 1.0) > 1e-5)
            REQUIRE(bvh->query({p.x, p.y}).size() == (nearest < 1.0 ? 1 : 0));
    }
}

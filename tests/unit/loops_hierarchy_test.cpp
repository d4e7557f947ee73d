// LOOPS's hierarchy against brute force: what is simplified crosses nothing that it did not cross before, at
// any tolerance, the same or another at every place; neighbours keep their borders.
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "error_kind.h"
#include "technique/loops/half_float.h"
#include "technique/loops/hierarchy.h"

using namespace decalgl;
using namespace decalgl::loops;

namespace {

constexpr double side = 1000.0;
const Bounds map_bounds{0.0, 0.0, side, side};

Layer layer_of(FeatureKind kind, const std::vector<std::vector<double>>& parts) {
    std::vector<double> coordinates;
    std::vector<int64_t> part_offsets = {0}, feature_offsets = {0};
    for (const std::vector<double>& part : parts) {
        coordinates.insert(coordinates.end(), part.begin(), part.end());
        part_offsets.push_back(static_cast<int64_t>(coordinates.size() / 2));
        feature_offsets.push_back(static_cast<int64_t>(part_offsets.size()) - 1);
    }
    Layer layer;
    layer.name = "test";
    layer.features = Features::own(kind, coordinates, part_offsets, feature_offsets);
    return layer;
}

Hierarchy hierarchy_of(const Layer& layer, const LoopsOptions& options = {}, unsigned threads = 2) {
    Progress progress;
    return build_hierarchy(Span<const Layer>(&layer, 1), map_bounds, PositionGrid::around(map_bounds),
                           Heightfield::flat(map_bounds, 0.0F), 0.0, options, threads, progress);
}

// A wavy ring around a place, which may come close to others.
std::vector<double> blob(std::mt19937& random, double x, double y, double radius, int vertices) {
    std::uniform_real_distribution<double> wave(0.55, 1.0);
    std::vector<double> ring;
    for (int i = 0; i < vertices; ++i) {
        const double angle = 2.0 * M_PI * i / vertices, r = radius * wave(random);
        ring.insert(ring.end(), {x + r * std::cos(angle), y + r * std::sin(angle)});
    }
    return ring;
}

// A country of `cells` x `cells` quadrangles with rough borders, of which each is drawn by both its neighbours.
// Along some borders only one of the two has a vertex.
std::vector<std::vector<double>> countries(int cells, int steps, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> jitter(-0.4, 0.4);
    const double size = side / cells;
    using Border = std::vector<std::pair<double, double>>;
    std::map<std::pair<int, int>, Border> across, along;
    const auto rough = [&](double x, double y, bool is_row) {
        Border border;
        for (int i = 0; i < steps; ++i) {
            const double t = size * i / steps, off = i == 0 ? 0.0 : jitter(random) * size * 0.5;
            border.emplace_back(x + (is_row ? t : off), y + (is_row ? off : t));
        }
        border.emplace_back(x + (is_row ? size : 0.0), y + (is_row ? 0.0 : size));
        return border;
    };
    for (int row = 0; row <= cells; ++row)
        for (int column = 0; column <= cells; ++column) {
            if (column < cells)
                across[{row, column}] = rough(column * size, row * size, true);
            if (row < cells)
                along[{row, column}] = rough(column * size, row * size, false);
        }
    std::vector<std::vector<double>> rings;
    for (int row = 0; row < cells; ++row)
        for (int column = 0; column < cells; ++column) {
            std::vector<double> ring;
            const auto add = [&](Border border, bool reversed) {
                if (reversed)
                    std::reverse(border.begin(), border.end());
                for (size_t i = 0; i + 1 < border.size(); ++i)
                    ring.insert(ring.end(), {border[i].first, border[i].second});
            };
            add(across[{row, column}], false);
            add(along[{row, column + 1}], false);
            add(across[{row + 1, column}], true);
            add(along[{row, column}], true);
            rings.push_back(ring);
        }
    return rings;
}

struct Edge {
    LatticePoint a, b;
};

int sign(int64_t value) {
    return (value > 0) - (value < 0);
}

// Whether two edges cross at a point inside both, or lie along each other in part.
bool cross(const Edge& e, const Edge& f) {
    const int a = sign(doubled_area(e.a, e.b, f.a)), b = sign(doubled_area(e.a, e.b, f.b));
    const int c = sign(doubled_area(f.a, f.b, e.a)), d = sign(doubled_area(f.a, f.b, e.b));
    if (a * b < 0 && c * d < 0)
        return true;
    // An end of one inside the other.
    const auto inside = [](const Edge& edge, LatticePoint p) {
        return p != edge.a && p != edge.b && doubled_area(edge.a, edge.b, p) == 0 &&
               triangle_holds(edge.a, edge.b, edge.b, p);
    };
    return inside(e, f.a) || inside(e, f.b) || inside(f, e.a) || inside(f, e.b);
}

// The least tolerance in a region of the map.
struct Tolerance {
    double everywhere;
    double lens = 0.0;  // inside a circle
    double x = 0.0, y = 0.0, radius = -1.0;

    bool activates(const Hierarchy& h, uint32_t point) const {
        const Activation& a = h.activations[point];
        const double error = h.error_of(point);
        const double region =
            half_to_double(uint16_t(a.error_and_radius >> 16)) / length_scale * h.lattice.quantum;
        const double distance = std::hypot(h.lattice.x_of({a.x, a.y}) - x, h.lattice.y_of({a.x, a.y}) - y);
        const bool in_lens = radius >= 0.0 && distance - region < radius;
        return error > (in_lens ? std::min(lens, everywhere) : everywhere);
    }
};

std::vector<Edge> edges_at(const Hierarchy& h, const Tolerance& tolerance) {
    std::vector<Edge> edges;
    for (size_t arc = 0; arc < h.arcs.count(); ++arc) {
        if (h.arcs.kinds[arc] == ArcKind::frame)
            continue;
        uint32_t last = h.arcs.begin(arc);
        for (uint32_t p = last + 1; p < h.arcs.end(arc); ++p)
            if (tolerance.activates(h, p)) {
                if (h.arcs.points[last] != h.arcs.points[p])
                    edges.push_back({h.arcs.points[last], h.arcs.points[p]});
                last = p;
            }
    }
    return edges;
}

size_t crossings(std::vector<Edge> edges) {
    size_t count = 0;
    const auto low = [](const Edge& e) { return std::min(e.a.x, e.b.x); };
    std::sort(edges.begin(), edges.end(), [&](const Edge& e, const Edge& f) { return low(e) < low(f); });
    for (size_t i = 0; i < edges.size(); ++i)
        for (size_t k = i + 1; k < edges.size() && low(edges[k]) <= std::max(edges[i].a.x, edges[i].b.x); ++k)
            count += cross(edges[i], edges[k]);
    return count;
}

// Active vertices whose parent is not, in the refinement tree.
size_t orphans(const Hierarchy& h, const Tolerance& tolerance) {
    size_t count = 0;
    for (uint32_t p = 0; p < h.arcs.points.size(); ++p) {
        const uint32_t parent = h.refinement.parents[p];
        count += parent != no_point && tolerance.activates(h, p) && !tolerance.activates(h, parent);
    }
    return count;
}

std::vector<Tolerance> tolerances(std::mt19937& random) {
    std::uniform_real_distribution<double> place(0.0, side);
    std::vector<Tolerance> all;
    for (int i = 0; i < 50; ++i)
        all.push_back({0.01 * std::pow(10.0, 0.1 * i)});
    for (int i = 0; i < 25; ++i)
        all.push_back({1e6, 0.1 * std::pow(2.0, i % 8), place(random), place(random), place(random) / 3});
    return all;
}

const std::vector<RemovalOrder> orders = {RemovalOrder::douglas_peucker, RemovalOrder::wang_mueller,
                                          RemovalOrder::visvalingam_whyatt};

}  // namespace

TEST_CASE("half floats are the least that are no smaller", "[loops]") {
    for (uint32_t half = 0; half < half_infinity; ++half) {
        const double value = half_to_double(static_cast<uint16_t>(half));
        REQUIRE(half_not_below(value) == half);
        REQUIRE(half_not_below(std::nextafter(value, INFINITY)) == half + 1);
    }
    CHECK(half_not_below(INFINITY) == half_infinity);
}

TEST_CASE("simplified rings cross nothing at any tolerance", "[loops]") {
    LoopsOptions options;
    options.order = GENERATE(from_range(orders));
    std::mt19937 random(7);
    std::uniform_real_distribution<double> place(0.0, side);
    std::vector<std::vector<double>> rings;
    // Islands in each other's bays: side by side and one inside the other.
    for (int i = 0; i < 25; ++i) {
        const double x = 100.0 + 200.0 * (i % 5), y = 100.0 + 200.0 * (i / 5);
        rings.push_back(blob(random, x, y, 99.0, 120));
        rings.push_back(blob(random, x, y, 50.0, 60));
        rings.push_back(blob(random, x, y, 20.0, 40));
    }
    const Hierarchy h = hierarchy_of(layer_of(FeatureKind::polygons, rings), options);
    REQUIRE(crossings(edges_at(h, {-1.0})) == 0);
    size_t fewest = SIZE_MAX;
    for (const Tolerance& tolerance : tolerances(random)) {
        const std::vector<Edge> edges = edges_at(h, tolerance);
        INFO(tolerance.everywhere << " " << tolerance.lens << " " << tolerance.radius);
        REQUIRE(crossings(edges) == 0);
        REQUIRE(orphans(h, tolerance) == 0);
        fewest = std::min(fewest, edges.size());
    }
    CHECK(fewest == 0);  // far away nothing is left
}

TEST_CASE("borders that neighbours share are simplified once", "[loops]") {
    LoopsOptions options;
    options.order = GENERATE(from_range(orders));
    const Layer layer = layer_of(FeatureKind::polygons, countries(6, 24, 3));
    const Hierarchy h = hierarchy_of(layer, options);
    std::mt19937 random(11);
    const size_t before = crossings(edges_at(h, {-1.0}));
    size_t most = 0, fewest = SIZE_MAX;
    for (const Tolerance& tolerance : tolerances(random)) {
        const std::vector<Edge> edges = edges_at(h, tolerance);
        REQUIRE(crossings(edges) <= before);
        REQUIRE(orphans(h, tolerance) == 0);
        most = std::max(most, edges.size());
        fewest = std::min(fewest, edges.size());
    }
    CHECK(fewest * 4 < most);
    for (const double tolerance : {0.0, 1.0, 10.0, 100.0}) {
        // Inner borders come twice, the outer ones once.
        const Features features = simplified(h, 0, FeatureKind::polygons, tolerance);
        std::map<std::set<std::pair<double, double>>, int> edges;
        for (size_t part = 0; part < features.part_count(); ++part) {
            const Span<const double> ring = features.part(part);
            for (size_t i = 0, n = ring.size() / 2; i < n; ++i) {
                const size_t k = (i + 1) % n;
                ++edges[{{ring[2 * i], ring[2 * i + 1]}, {ring[2 * k], ring[2 * k + 1]}}];
            }
        }
        for (const auto& edge : edges) {
            const bool outer = std::all_of(edge.first.begin(), edge.first.end(), [](const auto& p) {
                return p.first < 120.0 || p.second < 120.0 || p.first > side - 120.0 ||
                       p.second > side - 120.0;
            });
            REQUIRE((edge.second == 2 || (outer && edge.second == 1)));
        }
    }
}

TEST_CASE("T-junctions are noded", "[loops]") {
    // Two small squares along one side of a large one, which has no vertex between them.
    const Layer layer = layer_of(FeatureKind::polygons, {{100, 100, 500, 100.7, 500, 500, 100, 500},
                                                         {100, 100, 300, 100.35, 300, 0, 100, 0},
                                                         {300, 100.35, 500, 100.7, 500, 0, 300, 0}});
    const Hierarchy h = hierarchy_of(layer);
    CHECK(crossings(edges_at(h, {-1.0})) == 0);
    const Features features = simplified(h, 0, FeatureKind::polygons, 1e9);
    REQUIRE(features.part_count() == 3);
    bool has_junction = false;
    for (size_t i = 0; i < features.part(0).size(); i += 2)
        has_junction = has_junction || (std::abs(features.part(0)[i] - 300.0) < 1e-3);
    CHECK(has_junction);
}

TEST_CASE("errors of Douglas and Peucker bound the distance", "[loops]") {
    std::mt19937 random(5);
    const std::vector<double> ring = blob(random, 500, 500, 400, 800);
    const Hierarchy h = hierarchy_of(layer_of(FeatureKind::polygons, {ring}));
    for (const double tolerance : {1.0, 5.0, 20.0, 60.0}) {
        const Features features = simplified(h, 0, FeatureKind::polygons, tolerance);
        REQUIRE(features.part_count() == 1);
        const Span<const double> left = features.part(0);
        CHECK(left.size() < ring.size());
        for (size_t i = 0; i < ring.size(); i += 2) {
            double nearest = 1e9;
            for (size_t a = 0, n = left.size() / 2; a < n; ++a) {
                const size_t b = (a + 1) % n;
                nearest =
                    std::min(nearest, distance_to_segment(h.lattice.nearest(ring[i], ring[i + 1]),
                                                          h.lattice.nearest(left[2 * a], left[2 * a + 1]),
                                                          h.lattice.nearest(left[2 * b], left[2 * b + 1])));
            }
            REQUIRE(nearest * h.lattice.quantum <= tolerance + 1e-3);
        }
    }
}

TEST_CASE("orders name each vertex once, whatever the arc", "[loops]") {
    std::mt19937 random(9);
    std::uniform_int_distribution<int32_t> near(0, 6), far(0, 1 << 29);
    for (int i = 0; i < 2000; ++i) {
        std::vector<LatticePoint> arc(2 + random() % 40);
        for (LatticePoint& p : arc)
            p = i % 3 == 0   ? LatticePoint{near(random), near(random)}
                : i % 3 == 1 ? LatticePoint{near(random), 0}  // collinear, to and fro
                             : LatticePoint{far(random), far(random)};
        for (const auto order_by : {order_douglas_peucker, order_wang_mueller, order_visvalingam_whyatt}) {
            std::vector<Removal> order;
            order_by(arc, order);
            std::set<uint32_t> named;
            for (const Removal& removal : order) {
                REQUIRE((removal.vertex > 0 && removal.vertex + 1 < arc.size()));
                REQUIRE((std::isfinite(removal.error) && removal.error >= 0.0));
                named.insert(removal.vertex);
            }
            REQUIRE((order.size() == arc.size() - 2 && named.size() == order.size()));
        }
    }
}

TEST_CASE("a function of a user's own gives the order, and bad ones are refused", "[loops]") {
    std::mt19937 random(2);
    const Layer layer = layer_of(FeatureKind::polygons, {blob(random, 500, 500, 300, 50)});
    LoopsOptions options;
    options.order = RemovalOrder::function;
    options.function = [](Span<const double> xy) {
        std::vector<Removal> order;
        for (uint32_t i = 1; i + 1 < xy.size() / 2; ++i)
            order.push_back({i, double(i)});
        return order;
    };
    const Hierarchy h = hierarchy_of(layer, options);
    CHECK(simplified(h, 0, FeatureKind::polygons, 25.5).vertex_count() <= 27);
    options.function = [](Span<const double>) { return std::vector<Removal>{{1, 0.0}}; };
    CHECK_THROWS_AS(hierarchy_of(layer, options), Error);
}

TEST_CASE("bad rings are no trouble", "[loops]") {
    std::vector<double> bow = {100, 100, 400, 400, 400, 100, 100, 400};
    std::vector<double> spike = {500, 500, 600, 500, 900, 500, 600, 500, 600, 600};
    std::vector<double> collinear;
    for (int i = 0; i < 5000; ++i)
        collinear.insert(collinear.end(), {0.1 * i, 700.0});
    const Layer layer = layer_of(FeatureKind::polygons, {bow,
                                                         spike,
                                                         collinear,
                                                         {1, 1, 1, 1, 1, 1},
                                                         {5, 5, 9, 9},
                                                         {},
                                                         {-1e12, -1e12, 1e12, -1e12, 0, 1e12},
                                                         bow});
    const Hierarchy h = hierarchy_of(layer);
    std::mt19937 random(3);
    for (const Tolerance& tolerance : tolerances(random))
        REQUIRE(orphans(h, tolerance) == 0);
}

TEST_CASE("a hierarchy is the same on any number of threads", "[loops]") {
    std::mt19937 random(4);
    std::vector<std::vector<double>> rings = countries(12, 30, 8);
    for (int i = 0; i < 300; ++i)
        rings.push_back(blob(random, 500.0 + i, 500.0, 200.0, 30));
    const Layer layer = layer_of(FeatureKind::polygons, rings);
    const Hierarchy one = hierarchy_of(layer, {}, 1), many = hierarchy_of(layer, {}, 5);
    REQUIRE(one.activations.size() == many.activations.size());
    for (size_t i = 0; i < one.activations.size(); ++i) {
        const Activation &a = one.activations[i], &b = many.activations[i];
        REQUIRE((a.x == b.x && a.y == b.y && a.error_and_radius == b.error_and_radius &&
                 a.lowest_and_highest == b.lowest_and_highest));
    }
}

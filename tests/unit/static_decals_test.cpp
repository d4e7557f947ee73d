// The static index against brute force: every stream is well formed, and every point finds what covers it.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "decalgl/core/error.h"
#include "technique/static_decals/line_cells.h"
#include "technique/static_decals/prepared_decals.h"

using namespace decalgl;

namespace {

constexpr Bounds test_bounds{1000.0, 2000.0, 1997.0, 2991.0};

using Ring = std::vector<double>;

// Features of one part each.
Features features_of(FeatureKind kind, const std::vector<Ring>& parts) {
    std::vector<double> coordinates;
    std::vector<int64_t> part_offsets{0};
    std::vector<int64_t> feature_offsets{0};
    for (const Ring& part : parts) {
        coordinates.insert(coordinates.end(), part.begin(), part.end());
        part_offsets.push_back(static_cast<int64_t>(coordinates.size() / 2));
        feature_offsets.push_back(static_cast<int64_t>(part_offsets.size()) - 1);
    }
    return Features::own(kind, coordinates, part_offsets, feature_offsets);
}

Layer polygons(const std::vector<Ring>& rings) {
    return {"polygons", features_of(FeatureKind::polygons, rings), {200, 100, 50, 255}, {}, {}};
}

Layer lines(const std::vector<Ring>& parts, std::vector<double> widths) {
    return {"lines", features_of(FeatureKind::lines, parts), {20, 30, 40, 255}, std::move(widths), {}};
}

std::unique_ptr<PreparedDecals> build(const std::vector<Layer>& layers, unsigned threads = 0) {
    TechniqueInput input;
    input.layers = layers;
    input.bounds = test_bounds;
    input.positions = PositionGrid::around(test_bounds);
    input.threads = threads;
    Progress progress;
    return build_decals(input, progress);
}

void require_well_formed(const PreparedDecals& decals) {
    for (uint32_t cell = 0; cell < decals.grid.cell_count(); ++cell) {
        uint32_t at = decals.cell_starts[cell];
        const uint32_t end = decals.cell_starts[cell + 1];
        int64_t previous_slot = -1;
        while (at < end) {
            const CellTexel header = decals.texels[at++];
            REQUIRE(is_header(header));
            REQUIRE(int64_t{header.y} > previous_slot);
            REQUIRE(header.y < decals.slots.size());
            previous_slot = header.y;
            uint32_t pieces = 0;
            for (; at < end && !is_header(decals.texels[at]); ++at)
                ++pieces;
            REQUIRE((pieces > 0 || (header.x & GROUP_COVERS) != 0));
        }
        REQUIRE(decals.cell_starts[cell] <= end);
    }
}

// Even-odd on the rounded lattice, by a ray to the left.
bool inside(const CellGrid& grid, const Ring& ring, double x, double y) {
    bool result = false;
    const size_t count = ring.size() / 2;
    for (size_t i = 0; i < count; ++i) {
        const size_t j = (i + 1) % count;
        const auto snapped = [&](size_t k) { return Lattice(grid).nearest(ring[2 * k], ring[2 * k + 1]); };
        const double ax = grid.left() + static_cast<double>(snapped(i).x) * grid.quantum;
        const double ay = grid.bottom() + static_cast<double>(snapped(i).y) * grid.quantum;
        const double bx = grid.left() + static_cast<double>(snapped(j).x) * grid.quantum;
        const double by = grid.bottom() + static_cast<double>(snapped(j).y) * grid.quantum;
        if ((ay <= y) != (by <= y) && ax + (y - ay) / (by - ay) * (bx - ax) <= x)
            result = !result;
    }
    return result;
}

double distance_to(const Ring& line, double x, double y) {
    double nearest = 1e300;
    for (size_t i = 0; i + 3 < line.size(); i += 2) {
        const double dx = line[i + 2] - line[i], dy = line[i + 3] - line[i + 1];
        const double length2 = dx * dx + dy * dy;
        const double along = (x - line[i]) * dx + (y - line[i + 1]) * dy;
        const double t = length2 > 0.0 ? std::clamp(along / length2, 0.0, 1.0) : 0.0;
        nearest = std::min(nearest, std::hypot(x - line[i] - t * dx, y - line[i + 1] - t * dy));
    }
    return nearest;
}

double distance_to_ring(const Ring& ring, double x, double y) {
    Ring closed = ring;
    closed.insert(closed.end(), {ring[0], ring[1]});
    return distance_to(closed, x, y);
}

struct RandomMap {
    std::mt19937 engine;
    explicit RandomMap(unsigned seed) : engine(seed) {}

    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine);
    }

    // Vertices spread around the bounds; with `snap` above 0 they fall on multiples of it, so that edges run
    // along cell borders and meet at cell corners.
    Ring part(int vertices, double size, double snap) {
        const double x = between(test_bounds.min_x - 200, test_bounds.max_x + 200);
        const double y = between(test_bounds.min_y - 200, test_bounds.max_y + 200);
        Ring ring;
        for (int i = 0; i < vertices; ++i) {
            for (const double centre : {x, y}) {
                const double value = centre + between(-size, size);
                ring.push_back(snap > 0.0 ? std::round(value / snap) * snap : value);
            }
        }
        return ring;
    }
};

}  // namespace

TEST_CASE("polygons agree with brute force at random points", "[static]") {
    const double size = GENERATE(0.3, 5.0, 100.0, 2000.0);
    const double snap = GENERATE(0.0, 0.5, 8.0);
    RandomMap random(static_cast<unsigned>(size * 10 + snap));
    std::vector<Ring> rings;
    for (int i = 0; i < 25; ++i)
        rings.push_back(random.part(3 + i % 9, size, snap));
    const auto decals = build({polygons(rings)});
    require_well_formed(*decals);
    for (int sample = 0; sample < 3000; ++sample) {
        const Ring& near = rings[static_cast<size_t>(sample) % rings.size()];
        double x = std::clamp(near[0] + random.between(-size, size), test_bounds.min_x, test_bounds.max_x);
        double y = std::clamp(near[1] + random.between(-size, size), test_bounds.min_y, test_bounds.max_y);
        if (snap > 0.0 && sample % 3 == 0)
            x = std::clamp(std::round(x / snap) * snap, test_bounds.min_x, test_bounds.max_x);
        std::vector<bool> found(rings.size(), false);
        for (const FeatureReference& reference : decals->query(x, y))
            found[reference.feature] = true;
        for (size_t i = 0; i < rings.size(); ++i) {
            // Cuts at cell borders are rounded: within a quantum and a half of an edge either answer stands.
            if (distance_to_ring(rings[i], x, y) <= 1.5 * decals->grid.quantum)
                continue;
            REQUIRE(found[i] == inside(decals->grid, rings[i], x, y));
        }
    }
}

TEST_CASE("lines agree with brute force at random points", "[static]") {
    const double width = GENERATE(0.01, 0.8, 7.0, 90.0, 5000.0);
    const double size = GENERATE(0.5, 60.0, 3000.0);
    RandomMap random(static_cast<unsigned>(width * 100 + size));
    std::vector<Ring> parts;
    for (int i = 0; i < 25; ++i)
        parts.push_back(random.part(1 + i % 7, size, 0.0));
    const auto decals = build({lines(parts, {width})});
    require_well_formed(*decals);
    const double tolerance = 1.5 * decals->counts().quantum;
    for (int sample = 0; sample < 3000; ++sample) {
        const Ring& near = parts[static_cast<size_t>(sample) % parts.size()];
        const double reach = width + size;
        const double x =
            std::clamp(near[0] + random.between(-reach, reach), test_bounds.min_x, test_bounds.max_x);
        const double y =
            std::clamp(near[1] + random.between(-reach, reach), test_bounds.min_y, test_bounds.max_y);
        std::vector<bool> found(parts.size(), false);
        for (const FeatureReference& reference : decals->query(x, y))
            found[reference.feature] = true;
        for (size_t i = 0; i < parts.size(); ++i) {
            Ring line = parts[i];
            if (line.size() == 2)
                line.insert(line.end(), {line[0], line[1]});
            const double distance = distance_to(line, x, y);
            if (std::abs(distance - 0.5 * width) > tolerance)
                REQUIRE(found[i] == (distance < 0.5 * width));
        }
    }
}

TEST_CASE("neighbours that share a border own each point once", "[static]") {
    RandomMap random(7);
    constexpr int side = 12;
    // A grid of quadrilaterals over the bounds with shaken inner corners.
    std::vector<std::pair<double, double>> corners;
    for (int row = 0; row <= side; ++row) {
        for (int column = 0; column <= side; ++column) {
            const bool rim = row == 0 || column == 0 || row == side || column == side;
            corners.emplace_back(900.0 + column * 100.0 + (rim ? 0.0 : random.between(-45, 45)),
                                 1900.0 + row * 100.0 + (rim ? 0.0 : random.between(-45, 45)));
        }
    }
    std::vector<Ring> rings;
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            Ring ring;
            for (const int k : {0, 1, side + 2, side + 1}) {
                const auto& corner = corners[static_cast<size_t>(row * (side + 1) + column + k)];
                ring.insert(ring.end(), {corner.first, corner.second});
            }
            if ((row + column) % 2 != 0)
                for (size_t i = 0; i < 2; ++i) {
                    std::swap(ring[2 * i], ring[6 - 2 * i]);
                    std::swap(ring[2 * i + 1], ring[7 - 2 * i]);
                }
            rings.push_back(ring);
        }
    }
    const auto decals = build({polygons(rings)});
    for (int sample = 0; sample < 200000; ++sample) {
        // Most points lie on or next to a border.
        const auto& a = rings[static_cast<size_t>(sample) % rings.size()];
        const double t = random.between(0, 1);
        const double jitter = sample % 4 == 0 ? 0.0 : random.between(-1, 1) * decals->grid.quantum;
        const double x = std::clamp(a[0] + t * (a[2] - a[0]) + jitter, test_bounds.min_x, test_bounds.max_x);
        const double y = std::clamp(a[1] + t * (a[3] - a[1]) + jitter, test_bounds.min_y, test_bounds.max_y);
        REQUIRE(decals->query(x, y).size() == 1);
    }
}

TEST_CASE("the same bytes on any number of threads", "[static]") {
    RandomMap random(11);
    std::vector<Ring> rings;
    std::vector<Ring> parts;
    for (int i = 0; i < 4000; ++i)
        rings.push_back(random.part(40, 30.0, 0.0));
    for (int i = 0; i < 2000; ++i)
        parts.push_back(random.part(60, 80.0, 0.0));
    const std::vector<Layer> layers{polygons(rings), lines(parts, {3.0})};
    const auto one = build(layers, 1);
    const auto many = build(layers, 5);
    require_well_formed(*one);
    REQUIRE(one->cell_starts == many->cell_starts);
    const auto same = [](CellTexel a, CellTexel b) { return a.x == b.x && a.y == b.y; };
    REQUIRE(
        std::equal(one->texels.begin(), one->texels.end(), many->texels.begin(), many->texels.end(), same));
}

TEST_CASE("draw order, transparent features and rows", "[static]") {
    const Ring square{1100, 2100, 1200, 2100, 1200, 2200, 1100, 2200};
    Layer layer = polygons({square, square, square});
    layer.colors = {1, 2, 3, 255, 4, 5, 6, 0, 7, 8, 9, 128};
    layer.draw_order = {2, 1, 0};
    const auto decals = build({layer});
    const auto found = decals->query(1150, 2150);
    REQUIRE(found.size() == 2);
    CHECK(found[0].feature == 0);
    CHECK(found[1].feature == 2);
    CHECK(decals->has_translucency);
}

TEST_CASE("cancelling stops the build", "[static]") {
    RandomMap random(3);
    std::vector<Ring> rings;
    for (int i = 0; i < 2000; ++i)
        rings.push_back(random.part(50, 50.0, 0.0));
    const std::vector<Layer> layers{polygons(rings)};
    TechniqueInput input;
    input.layers = layers;
    input.bounds = test_bounds;
    input.positions = PositionGrid::around(test_bounds);
    Progress progress([](std::string_view, double) { return false; }, "layers");
    try {
        build_decals(input, progress);
        FAIL("not cancelled");
    } catch (const Error& error) {
        CHECK(error.kind() == ErrorKind::cancelled);
    }
}

TEST_CASE("many large polygons over each other do not fill the memory", "[static]") {
    std::vector<Ring> rings;
    for (int i = 0; i < 2000; ++i) {
        const double inset = 0.01 * i;
        rings.push_back({1000 + inset, 2000 + inset, 1900, 2000, 1900, 2900, 1000, 2900 - inset});
    }
    const auto decals = build({polygons(rings)});
    CHECK(decals->charge.bytes() < (uint64_t{128} << 20));
    CHECK(decals->query(1500, 2500).size() == rings.size());
}

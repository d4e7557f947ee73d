// The static index against brute force: every stream is well formed, and every point finds what covers it.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "decalgl/core/error.h"
#include "technique/static_decals/levels.h"
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
    Layer layer;
    layer.name = "polygons";
    layer.features = features_of(FeatureKind::polygons, rings);
    layer.fill.colors = {200, 100, 50, 255};
    return layer;
}

Layer lines(const std::vector<Ring>& parts, std::vector<double> widths) {
    Layer layer;
    layer.name = "lines";
    layer.features = features_of(FeatureKind::lines, parts);
    layer.stroke.colors = {20, 30, 40, 255};
    layer.stroke.widths = std::move(widths);
    return layer;
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

// One list: groups in draw order, points with an edge's beginning first, LIST_END to the texel's end.
void require_list(const PreparedDecals& decals, Span<const uint32_t> words) {
    int64_t previous_slot = -1;
    bool has_point = false, ended = false;
    for (const uint32_t word : words) {
        REQUIRE((!ended || word == LIST_END));
        if (word == LIST_END) {
            ended = true;
        } else if ((word & HEADER) != 0) {
            const uint32_t slot = word & SLOT_MASK;
            REQUIRE(int64_t{slot} > previous_slot);
            REQUIRE(slot < decals.slots.size());
            REQUIRE(((word & LINE) != 0) == (decals.styles[slot].half_width > 0.0F));
            previous_slot = slot;
            has_point = false;
        } else {
            REQUIRE(previous_slot >= 0);
            REQUIRE((has_point || (word & MOVE) != 0));
            has_point = true;
        }
    }
}

void require_well_formed(const PreparedDecals& decals) {
    REQUIRE(decals.bucket_entries.size() == decals.grid.bucket_count());
    size_t cells = 0;
    for (const uint32_t bucket : decals.bucket_entries) {
        const uint32_t level = bucket & ((1U << LEVEL_BITS) - 1);
        REQUIRE((level == 0 || (level >= COARSEST_LEVEL && level <= FINEST_LEVEL)));
        REQUIRE(bucket >> LEVEL_BITS == cells);
        cells += size_t{1} << (2 * level);
    }
    REQUIRE(cells == decals.cells.size());
    for (const uint32_t entry : decals.cells) {
        const size_t first = size_t{4} * (entry >> COUNT_BITS);
        size_t count = size_t{4} * (entry & COUNT_ESCAPE);
        if ((entry & COUNT_ESCAPE) == COUNT_ESCAPE)
            while (decals.words[first + count - 1] != LIST_END)
                count += 4;
        REQUIRE(first + count <= decals.words.size());
        require_list(decals, {decals.words.data() + first, count});
    }
}

// Even-odd on the rounded lattice, by a ray to the left.
bool inside(const BucketGrid& grid, const Ring& ring, double x, double y) {
    bool result = false;
    const size_t count = ring.size() / 2;
    for (size_t i = 0; i < count; ++i) {
        const size_t j = (i + 1) % count;
        const auto snapped = [&](size_t k) { return Lattice(grid).nearest(&ring[2 * k]); };
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
        for (const FeatureReference& reference : decals->query({x, y}))
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
        for (const FeatureReference& reference : decals->query({x, y}))
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
        REQUIRE(decals->query({x, y}).size() == 1);
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
    REQUIRE(one->bucket_entries == many->bucket_entries);
    REQUIRE(one->cells == many->cells);
    REQUIRE(one->words == many->words);
}

TEST_CASE("a ring is the same whether one run holds it or many do", "[static]") {
    // A star whose rays cross many buckets, and the same one as parts of a feature with as many empty ones.
    constexpr size_t vertices = 120000;
    Ring star;
    RandomMap random(5);
    for (size_t i = 0; i < vertices; ++i) {
        const double angle = 6.283185307179586 * static_cast<double>(i) / vertices;
        const double radius = i % 2 == 0 ? random.between(100.0, 250.0) : random.between(350.0, 600.0);
        star.insert(star.end(), {1500.0 + radius * std::cos(angle), 2500.0 + radius * std::sin(angle)});
    }
    const auto decals = build({polygons({star})}, 3);
    require_well_formed(*decals);
    for (int sample = 0; sample < 300; ++sample) {
        const double x = random.between(1000.0, 1997.0), y = random.between(2000.0, 2991.0);
        if (distance_to_ring(star, x, y) > 1.5 * decals->grid.quantum)
            REQUIRE(decals->query({x, y}).size() == (inside(decals->grid, star, x, y) ? 1 : 0));
    }
}

TEST_CASE("long lists end where they should", "[static]") {
    std::vector<Ring> rings;
    for (int i = 0; i < 700; ++i)
        rings.push_back({1500, 2500, 1500.5, 2500, 1500.5, 2500.5, 1500, 2500.5});
    const auto decals = build({polygons(rings)});
    require_well_formed(*decals);
    CHECK(decals->longest_list > 4 * COUNT_ESCAPE);
    CHECK(decals->query({1500.25, 2500.25}).size() == rings.size());
    CHECK(decals->query({1500.25, 2500.75}).empty());
}

TEST_CASE("dense places have finer cells", "[static]") {
    RandomMap random(13);
    std::vector<Ring> parts;
    for (int i = 0; i < 8000; ++i) {
        const double x = random.between(1100.0, 1110.0), y = random.between(2100.0, 2110.0);
        parts.push_back({x, y, x + random.between(-0.1, 0.1), y + random.between(-0.1, 0.1)});
    }
    parts.push_back({1600, 2600, 1900, 2900});
    const auto decals = build({lines(parts, {0.05})});
    require_well_formed(*decals);
    const auto level_at = [&](double x, double y) {
        const auto column = static_cast<int64_t>((x - decals->grid.left()) / decals->grid.bucket_size);
        const auto row = static_cast<int64_t>((y - decals->grid.bottom()) / decals->grid.bucket_size);
        return decals->bucket_entries[decals->grid.bucket_index(column, row)] & ((1U << LEVEL_BITS) - 1);
    };
    CHECK(level_at(1105.0, 2105.0) == FINEST_LEVEL);
    CHECK(level_at(1700.0, 2700.0) == COARSEST_LEVEL);
    CHECK(level_at(1300.0, 2900.0) == 0);
}

TEST_CASE("draw order, transparent features and rows", "[static]") {
    const Ring square{1100, 2100, 1200, 2100, 1200, 2200, 1100, 2200};
    Layer layer = polygons({square, square, square});
    layer.fill.colors = {1, 2, 3, 255, 4, 5, 6, 0, 7, 8, 9, 128};
    layer.draw_order = {2, 1, 0};
    const auto decals = build({layer});
    const auto found = decals->query({1150, 2150});
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
    CHECK(decals->counts().bytes < (uint64_t{128} << 20));
    CHECK(decals->query({1500, 2500}).size() == rings.size());
}

TEST_CASE("levels of detail keep the coverage of fills and lines", "[static]") {
    RandomMap random(17);
    std::vector<Ring> rings, parts;
    for (int i = 0; i < 30; ++i)
        rings.push_back(random.part(3 + i % 5, 150.0, 0.0));
    for (int i = 0; i < 60; ++i)
        parts.push_back(random.part(4, 200.0, 0.0));
    const double width = GENERATE(0.7, 60.0);
    const auto decals = build({polygons(rings), lines(parts, {width})});
    const int texels = GENERATE(LEVEL_TEXELS, LEVEL_TEXELS / 4);
    const LevelRaster raster = LevelPainter(texels).draw(*decals);
    const double texel = decals->grid.bucket_size / texels;
    REQUIRE(raster.width == decals->grid.columns * texels);
    // Means over blocks of 8 x 8 texels against as many points as an area needs.
    double bias = 0.0;
    int blocks = 0;
    for (int row = 0; row + 8 <= raster.height; row += 8) {
        for (int column = 0; column + 8 <= raster.width; column += 8) {
            double drawn = 0.0, hit = 0.0;
            for (int y = 0; y < 8; ++y)
                for (int x = 0; x < 8; ++x)
                    drawn +=
                        raster.texels[static_cast<size_t>(4 * ((row + y) * raster.width + column + x) + 3)] /
                        255.0;
            constexpr int points = 400;
            for (int i = 0; i < points; ++i) {
                const double x = decals->grid.left() + (column + 8.0 * random.between(0, 1)) * texel;
                const double y = decals->grid.bottom() + (row + 8.0 * random.between(0, 1)) * texel;
                hit += decals->query({x, y}).empty() ? 0.0 : 1.0;
            }
            const double difference = drawn / 64.0 - hit / points;
            REQUIRE(std::abs(difference) < 0.13);  // five deviations of 400 points
            bias += difference;
            ++blocks;
        }
    }
    CHECK(blocks > 50);
    CHECK(std::abs(bias / blocks) < 0.005);
}

// Networks as nodes and segments, the ground under them, their categories and what mends their artefacts.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "error_kind.h"
#include "technique/distance_field/drop_offs.h"
#include "technique/distance_field/mends.h"
#include "technique/distance_field/prepared_network.h"

using namespace decalgl;
using namespace decalgl::network;
using namespace decalgl::test;

namespace {

Layer layer_of(const std::vector<std::vector<double>>& parts, double width) {
    Layer layer;
    layer.name = "roads";
    std::vector<double> coordinates;
    std::vector<int64_t> part_offsets{0}, feature_offsets{0};
    for (const std::vector<double>& part : parts) {
        coordinates.insert(coordinates.end(), part.begin(), part.end());
        part_offsets.push_back(static_cast<int64_t>(coordinates.size() / 2));
        feature_offsets.push_back(static_cast<int64_t>(part_offsets.size() - 1));
    }
    layer.features = Features::own(FeatureKind::lines, coordinates, part_offsets, feature_offsets);
    layer.stroke.colors = {255, 0, 0, 255};
    layer.stroke.widths = {width};
    return layer;
}

// Waves of 30 m over 1 km, with a hole.
Heightfield waves() {
    std::vector<float> heights;
    for (int row = 0; row < 101; ++row)
        for (int column = 0; column < 101; ++column)
            heights.push_back(row > 40 && row < 50 && column > 60 && column < 80
                                  ? NAN
                                  : 30.0F * std::sin(0.3F * static_cast<float>(row)) *
                                        std::cos(0.2F * static_cast<float>(column)));
    return Heightfield(heights, 101, 101, 0.0, 1000.0, 10.0, 10.0);
}

struct Example {
    Heightfield terrain = waves();
    std::vector<Layer> layers;
    std::unique_ptr<PreparedNetwork> network;

    Example(std::vector<Layer> given, std::shared_ptr<const DistanceFieldOptions> options = nullptr)
        : layers(std::move(given)) {
        for (Layer& layer : layers)
            layer.technique = {"distance_field", options};
        TechniqueInput input;
        input.layers = layers;
        input.terrain = &terrain;
        input.bounds = terrain.bounds();
        input.positions = PositionGrid::around(input.bounds);
        Progress progress;
        network = prepare_network(input, progress);
    }

    const Network& made() const { return *network->network; }
};

NetworkCategory category(const std::string& name, double width) {
    NetworkCategory made;
    made.name = name;
    NetworkStyle style;
    style.width = width;
    style.main_color = {1.0F, 1.0F, 1.0F, 1.0F};
    made.styles = {style};
    return made;
}

}  // namespace

TEST_CASE("places are nodes, whichever lines meet there") {
    const Example prepared(
        {layer_of({{100, 100, 200, 100, 300, 100}, {200, 100, 200, 200}, {300, 100, 300, 100}}, 8)});
    const Network& network = prepared.made();
    REQUIRE(network.nodes.size() == 4);
    REQUIRE(network.segments.size() == 4);
    CHECK(network.nodes[network.segments[0].b].grade() == 3);
    CHECK(network.segments[0].ends == LINE_ENDS_AT_A);
    CHECK(network.segments[1].ends == LINE_ENDS_AT_B);
    CHECK(network.segments[1].start == 100.0F);
    CHECK(network.segments[2].ends == (LINE_ENDS_AT_A | LINE_ENDS_AT_B));
    CHECK(network.segments[3].a == network.segments[3].b);  // a dot
    for (const Segment& segment : network.segments)
        CHECK(network.place(segment.a)[1] == Approx(100.0).margin(network.lattice.quantum));
}

TEST_CASE("long segments are pieces without caps between them, and what lies outside is cut away") {
    const Example prepared({layer_of({{-1e9, 500, 1e9, 500}, {-5000, -5000, -4000, -5000}}, 8)});
    const Network& network = prepared.made();
    REQUIRE(network.segments.size() == 2);  // 1008 m of pieces of up to 640 m
    CHECK(network.segments[0].ends == PLAIN_A);
    CHECK(network.segments[1].ends == PLAIN_A);
    CHECK(network.segments[1].start - network.segments[0].start == Approx(504.0).margin(64.0));
    CHECK(network.place(network.segments[0].a)[0] == Approx(-4.0).margin(0.01));
    CHECK(network.place(network.segments[1].b)[0] == Approx(1004.0).margin(0.01));
}

TEST_CASE("ranges of heights hold every sample around a rectangle") {
    const Heightfield terrain = waves();
    const MemoryAccount memory;
    const HeightRanges ranges(terrain, 0, memory, "ground");
    std::mt19937 generator(5);
    std::uniform_real_distribution<double> place(-100.0, 1100.0);
    for (int i = 0; i < 2000; ++i) {
        const double x = place(generator), y = place(generator), reach = std::abs(place(generator)) / 5.0;
        const Bounds box{x - reach, y - reach, x + reach, y + reach};
        const HeightRange found = ranges.over(box);
        const bool is_beyond = box.max_x < 0.0 || box.min_x > 1000.0 || box.max_y < 0.0 || box.min_y > 1000.0;
        REQUIRE((!is_beyond || found.empty()));
        if (is_beyond)
            continue;
        for (int row = 0; row < 101; ++row)
            for (int column = 0; column < 101; ++column) {
                const double sx = 10.0 * column, sy = 1000.0 - 10.0 * row;
                const bool near = sx > box.min_x - 10.0 && sx < box.max_x + 10.0 && sy > box.min_y - 10.0 &&
                                  sy < box.max_y + 10.0;
                const float height = terrain.height(row, column);
                if (!near || std::isnan(height))
                    continue;
                REQUIRE(found.lowest <= height);
                REQUIRE(found.highest >= height);
            }
        const uint32_t packed = ranges.packed(found);
        if (!found.empty()) {
            REQUIRE(ranges.lowest() + ranges.step() * (packed & 0xFFFFU) <= double{found.lowest} + 1e-6);
            REQUIRE(ranges.lowest() + ranges.step() * (packed >> 16U) >= double{found.highest} - 1e-6);
        }
    }
    CHECK((ranges.packed({INFINITY, -INFINITY}) & 0xFFFFU) > ranges.packed({INFINITY, -INFINITY}) >> 16U);
}

TEST_CASE("features that look the same are a category, in draw order") {
    Layer layer = layer_of({{0, 0, 9, 9}, {0, 9, 9, 0}, {5, 0, 5, 9}, {0, 5, 9, 5}}, 8);
    layer.stroke.colors = {9, 9, 9, 255, 1, 1, 1, 255, 9, 9, 9, 255, 0, 0, 0, 0};
    layer.draw_order = {1, 0, 2, 3};
    const CategoryTable table = make_categories(Span<const Layer>(&layer, 1), DistanceFieldOptions());
    REQUIRE(table.categories.size() == 2);
    CHECK(table.slots[1].category == 0);
    CHECK(table.slots[0].category == 1);
    CHECK(table.slots[2].category == 1);
    CHECK(!table.slots[3].shows());
    CHECK(table.slots[0].order < table.slots[2].order);
    CHECK(table.slots[1].order < table.slots[0].order);
}

TEST_CASE("styles between two levels of detail are a mean of both") {
    NetworkCategory two = category("two", 10.0);
    NetworkStyle far = two.styles[0];
    far.lod = 0.5;
    far.width = 30.0;
    far.main_color = {0.0F, 0.0F, 0.0F, 1.0F};
    two.styles.push_back(far);
    CHECK(style_at(two, 0.0).width == 10.0);
    CHECK(style_at(two, 0.25).width == Approx(20.0));
    CHECK(style_at(two, 0.25).main_color[0] == Approx(0.5F));
    CHECK(style_at(two, 0.9).width == 30.0);
    CHECK(widest_half_width(two) == 15.0);
}

TEST_CASE("ends at other categories are cut, and lines of one category are kept apart") {
    auto options = std::make_shared<DistanceFieldOptions>();
    options->categories = {category("wide", 40.0), category("narrow", 10.0), category("unused", 90.0)};
    options->category_of = {0, 1, 0, no_network_category};
    options->mend_protrusion = options->mend_intrusion = true;
    options->widths_at = LodPlace::vertex;
    const Example prepared(
        {layer_of({{500, 500, 500, 600}, {400, 500, 500, 500, 600, 500}, {520, 530, 520, 600}, {0, 0, 9, 9}},
                  1)},
        options);
    const Network& network = prepared.made();
    CHECK(prepared.network->table.categories.size() == 2);
    CHECK(prepared.network->table.reach == 20.0);
    CHECK((network.segments[0].ends >> CUT_A_SHIFT & CUT_MASK) == 2);
    CHECK((network.segments[0].ends >> CUT_B_SHIFT & CUT_MASK) == 0);
    const auto clearance = [&](uint32_t node) {
        return 20.0 * (network.nodes[node].marks >> NODE_CLEARANCE_SHIFT) / clearance_steps;
    };
    CHECK(clearance(network.segments[0].b) == Approx(0.9 * 10.0).margin(1e-3));
    CHECK(clearance(network.segments[1].a) == Approx(20.0));
}

TEST_CASE("drop-offs are 0 on the line and 1 where fields end") {
    const auto at = [](int layer, int row, int column) {
        return drop_off_texels(layer)[static_cast<size_t>(row * drop_off_side + column)] / 255.0;
    };
    CHECK(at(0, 256, 7) == Approx(256.0 / 511.0).margin(0.002));
    CHECK(at(1, 300, 200) == Approx(std::hypot(300, 200) / 511.0).margin(0.002));
    CHECK(at(2, 300, 200) == Approx(300.0 / 511.0).margin(0.002));
    CHECK(at(3, 0, 0) == 1.0);
    CHECK(at(1, 511, 511) == 1.0);
}

TEST_CASE("options that contradict themselves are refused") {
    DistanceFieldOptions options;
    options.bits = 16;
    CHECK(kind_of([&] { validate(options); }) == ErrorKind::style);
    options = {};
    options.mend_intrusion = true;
    CHECK(kind_of([&] { validate(options); }) == ErrorKind::style);
    options = {};
    options.category_of = {3};
    CHECK(kind_of([&] { validate(options); }) == ErrorKind::input);
    options = {};
    options.categories = {category("a", -1.0)};
    CHECK(kind_of([&] { validate(options); }) == ErrorKind::style);
    options = {};
    options.rasters = {{2, 2, {1, 2, 3}}};
    CHECK(kind_of([&] { validate(options); }) == ErrorKind::style);
    options = {};
    options.lod.source = LodSource::texture;
    CHECK(kind_of([&] { validate(options); }) == ErrorKind::style);
}

TEST_CASE("a network that does not fit into its budget is refused before it is made") {
    const Heightfield terrain = waves();
    CHECK(kind_of([&] { HeightRanges(terrain, 0, MemoryAccount(1000), "ground"); }) == ErrorKind::memory);
}

// The shader functions of strokes, a pixel a case, against double precision on the CPU.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "one_pixel.h"
#include "vector/stroke_reach.h"

using namespace decalgl;
using glm::vec4;
using test::OnePixel;

namespace {

const std::string stroke = "shared/stroke.glsl";
const std::string coverage = "shared/thoeny_coverage.glsl";

class Dice {
public:
    explicit Dice(unsigned seed) : generator_(seed) {}

    float between(float low, float high) {
        return std::uniform_real_distribution<float>(low, high)(generator_);
    }
    uint32_t below(uint32_t count) { return static_cast<uint32_t>(generator_() % count); }
    Vector2 direction() {
        const double angle = between(0.0F, 6.2831853F);
        return {double(float(std::cos(angle))), double(float(std::sin(angle)))};
    }

private:
    std::mt19937 generator_;
};

vec4 packed(Vector2 a, Vector2 b) {
    return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(b.x),
            static_cast<float>(b.y)};
}

// Out of reach in both, or as far in both.
void require_same_reach(double found, double expected) {
    if (expected >= 1e30)
        REQUIRE(found >= 1e30);
    else
        REQUIRE(std::abs(found - expected) <= 1e-4 * (1.0 + expected));
}

}  // namespace

TEST_CASE("corners reach as far as on the CPU") {
    OnePixel shader({stroke}, 3,
                    "result.x = corner_reach(uint(input2.x), input0.xy, input0.zw, input1.xy, input2.y);\n");
    Dice dice(1);
    std::vector<vec4> values;
    std::vector<double> expected;
    for (int i = 0; i < 20000; ++i) {
        const Vector2 coming = dice.direction();
        Vector2 going = dice.direction();
        if (i % 10 == 1)
            going = coming;
        if (i % 10 == 2)
            going = {-coming.x, -coming.y};
        if (i % 10 == 3)
            going = {-coming.y, coming.x};
        const Vector2 from{double(dice.between(-9, 9)), double(dice.between(-9, 9))};
        // Which side a point lies on, and whether a corner is too sharp, is no question of the last digit.
        const float limit = std::cos(static_cast<float>(dice.below(10)) * 20.0F * 0.0174532925F);
        if (std::abs(dot(from, coming)) < 1e-4 || std::abs(dot(from, going)) < 1e-4 ||
            std::abs(dot(coming, going) + double(limit)) < 1e-4)
            continue;
        // A bevel is almost nothing where the way is almost straight.
        const uint32_t corner = i % 10 == 1 || i % 10 == 2 ? dice.below(2) : dice.below(3);
        values.push_back(packed(from, coming));
        values.push_back(packed(going, {}));
        values.emplace_back(static_cast<float>(corner), limit, 0, 0);
        expected.push_back(corner_reach(static_cast<Corner>(corner), from, coming, going, double(limit)));
    }
    const std::vector<vec4> results = shader.run(values);
    for (size_t i = 0; i < results.size(); ++i) {
        INFO("case " << i);
        if (expected[i] < 1e4)
            require_same_reach(double{results[i].x}, expected[i]);
    }
}

TEST_CASE("bars, caps and dots reach as far as on the CPU") {
    OnePixel shader({stroke}, 3,
                    "vec2 direction = input1.xy;\n"
                    "float apart = cross_product(direction, input0.xy);\n"
                    "result.x = bar_reach(input0.xy, input0.zw, direction, apart, input1.zw);\n"
                    "result.y = cap_reach(uint(input2.x), input0.xy);\nresult.z = dot_reach(uint(input2.x), "
                    "input0.xy);\n");
    Dice dice(2);
    std::vector<vec4> values;
    std::vector<std::array<double, 3>> expected;
    for (int i = 0; i < 10000; ++i) {
        const Vector2 direction = dice.direction(),
                      from{double(dice.between(-9, 9)), double(dice.between(-9, 9))};
        const double length = dice.below(3) == 0 ? 0.0 : dice.between(0, 9);
        const Vector2 from_b{from.x - length * direction.x, from.y - length * direction.y};
        const Vector2 longer{double(dice.below(3)), double(dice.below(3))};
        if (std::abs(dot(from, direction) + longer.x) < 1e-4 ||
            std::abs(dot(from_b, direction) - longer.y) < 1e-4)
            continue;
        const uint32_t cap = dice.below(3);
        values.push_back(packed(from, from_b));
        values.push_back(packed(direction, longer));
        values.emplace_back(static_cast<float>(cap), 0, 0, 0);
        expected.push_back({bar_reach(from, from_b, direction, longer),
                            cap_reach(static_cast<Cap>(cap), from), dot_reach(static_cast<Cap>(cap), from)});
    }
    const std::vector<vec4> results = shader.run(values);
    for (size_t i = 0; i < results.size(); ++i)
        for (int k = 0; k < 3; ++k)
            require_same_reach(double{results[i][k]}, expected[i][static_cast<size_t>(k)]);
}

TEST_CASE("marks of a pattern are as wide as on the CPU") {
    OnePixel shader({stroke}, 2, "result.x = mark_width(input0, pattern_phase(input1.x, input1.y));\n");
    Dice dice(3);
    std::vector<vec4> values;
    std::vector<double> expected;
    for (int i = 0; i < 10000; ++i) {
        const float begin = dice.between(0, 4), end = begin + dice.between(0.1F, 4.0F),
                    along = dice.between(-50, 50);
        const PatternMark mark{double(begin), double(end), double(dice.between(0, 1)),
                               double(dice.between(0, 1))};
        const double phase = pattern_phase(double{along}, 9.0);
        if (std::abs(phase - mark.begin) < 1e-4 || std::abs(phase - mark.end) < 1e-4)
            continue;
        values.emplace_back(begin, end, static_cast<float>(mark.begin_width),
                            static_cast<float>(mark.end_width));
        values.emplace_back(along, 9.0F, 0, 0);
        expected.push_back(mark_width(mark, phase));
    }
    const std::vector<vec4> results = shader.run(values);
    for (size_t i = 0; i < results.size(); ++i)
        REQUIRE(std::abs(double{results[i].x} - expected[i]) <= 1e-4);
}

TEST_CASE("lengths on a slope are those of the vectors laid onto it") {
    OnePixel shader(
        {stroke}, 1,
        "vec2 laid = tangent_lengths(input0.xy) * input0.zw;\n"
        "result = vec4(length(laid), thoeny_width(input0.xy, 0.0), thoeny_width(input0.xy, -1.0), "
        "laid.y);\n");
    Dice dice(4);
    std::vector<vec4> values;
    for (int i = 0; i < 2000; ++i) {
        const float steepness = i % 10 == 0 ? 0.0F : dice.between(0, 4);
        values.emplace_back(steepness * dice.between(-1, 1), steepness * dice.between(-1, 1),
                            dice.between(-9, 9), dice.between(-9, 9));
    }
    const std::vector<vec4> results = shader.run(values);
    for (size_t i = 0; i < results.size(); ++i) {
        const Vector2 gradient{double{values[i].x}, double{values[i].y}},
            way{double{values[i].z}, double{values[i].w}};
        REQUIRE(std::abs(double{results[i].x} - std::hypot(length(way), dot(gradient, way))) <= 1e-4);
        REQUIRE(std::abs(double{results[i].y} - 1.0 / std::hypot(1.0, length(gradient))) <= 1e-5);
        REQUIRE(std::abs(double{results[i].z} - 1.0) <= 1e-6);
    }
}

TEST_CASE("Thöny's coverage is exact for lines along a side of the pixel") {
    OnePixel shader(
        {coverage}, 2,
        "result.x = thoeny_coverage(input0.x, input0.y, input0.z);\n"
        "result.y = thoeny_mark_coverage(input1.x, input1.y, input1.z, input1.w, input0.z);\n"
        "mat2 foot = mat2(3.0, 0.0, 0.0, 4.0);\n"
        "result.z = pixel_width(foot, vec2(1.0, 0.0));\nresult.w = pixel_width(foot, vec2(0.6, 0.8));\n");
    Dice dice(5);
    std::vector<vec4> values;
    std::vector<std::array<double, 2>> expected;
    for (int i = 0; i < 5000; ++i) {
        const double apart = dice.between(0, 5), half = dice.between(0, 3), pixel = dice.between(0.1F, 4.0F);
        const double begin = dice.between(0, 3), end = begin + dice.between(0.1F, 3.0F), period = 6.5;
        const double at = dice.between(-20, 20);
        const auto overlap = [](double a, double b, double c, double d) {
            return std::max(std::min(b, d) - std::max(a, c), 0.0);
        };
        double marks = 0.0;
        for (int turn = -10; turn <= 10; ++turn)
            marks += overlap(at - 0.5 * pixel, at + 0.5 * pixel, begin + turn * period, end + turn * period);
        values.emplace_back(apart, half, pixel, 0);
        values.emplace_back(begin, end, period, at);
        expected.push_back(
            {overlap(-0.5 * pixel, 0.5 * pixel, apart - half, apart + half) / pixel, marks / pixel});
    }
    const std::vector<vec4> results = shader.run(values);
    for (size_t i = 0; i < results.size(); ++i) {
        REQUIRE(std::abs(double{results[i].x} - expected[i][0]) <= 1e-4);
        REQUIRE(std::abs(double{results[i].y} - expected[i][1]) <= 1e-3);
        REQUIRE(results[i].z == 3.0F);
        REQUIRE(std::abs(double{results[i].w} - std::hypot(1.8, 3.2)) <= 1e-5);
    }
}

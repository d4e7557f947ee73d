// The shader functions of the BVH index, each against 64-bit and double precision on the CPU.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "one_pixel.h"
#include "technique/static_bvh/complete_tree.h"

using namespace decalgl;
using glm::vec4;
using test::OnePixel;

namespace {

const std::string integers = "technique/static_bvh/integers.glsl";
const std::string tree = "technique/static_bvh/tree.glsl";
const std::string strokes = "technique/static_bvh/strokes.glsl";
const std::string quad_trees = "technique/static_bvh/quad_trees.glsl";

class Dice {
public:
    explicit Dice(unsigned seed) : generator_(seed) {}

    int32_t up_to(int32_t most) { return std::uniform_int_distribution<int32_t>(-most, most)(generator_); }

private:
    std::mt19937 generator_;
};

// Integers travel as two halves, which float32 holds.
const std::string read_integers = "ivec4 whole = ivec4(input0) * 65536 + ivec4(input1);\n";

void add_case(std::vector<vec4>& values, const int32_t (&four)[4]) {
    vec4 high, low;
    for (int i = 0; i < 4; ++i) {
        high[i] = std::floor(static_cast<float>(static_cast<double>(four[i]) / 65536.0));
        low[i] = static_cast<float>(four[i] - static_cast<int64_t>(high[i]) * 65536);
    }
    values.insert(values.end(), {high, low});
}

}  // namespace

TEST_CASE("products of 32-bit differences keep all their digits") {
    OnePixel shader(
        {integers}, 2,
        read_integers +
            "Wide cross = wide_cross(whole.xy, whole.zw), dotted = wide_dot(whole.xy, whole.zw);\n"
            "result = vec4(cross.high >= 0, magnitude(cross), dotted.high >= 0, magnitude(dotted));\n");
    Dice dice(1);
    std::vector<vec4> values;
    std::vector<std::array<int64_t, 2>> expected;
    for (int i = 0; i < 20000; ++i) {
        const int32_t most = i % 3 == 0 ? 20 : i % 3 == 1 ? 40000 : 1610612735;
        int32_t four[4] = {dice.up_to(most), dice.up_to(most), dice.up_to(most), dice.up_to(most)};
        if (i % 5 == 0) {
            // Almost parallel: the products differ in their last digits alone.
            four[2] = four[0] + dice.up_to(1);
            four[3] = four[1] + dice.up_to(1);
        }
        add_case(values, four);
        expected.push_back({int64_t{four[0]} * four[3] - int64_t{four[1]} * four[2],
                            int64_t{four[0]} * four[2] + int64_t{four[1]} * four[3]});
    }
    const std::vector<vec4> results = shader.run(values);
    for (size_t i = 0; i < results.size(); ++i) {
        INFO("case " << i);
        REQUIRE((results[i].x == 1.0F) == (expected[i][0] >= 0));
        REQUIRE((results[i].z == 1.0F) == (expected[i][1] >= 0));
        const auto cross = static_cast<double>(std::abs(expected[i][0]));
        const auto dot = static_cast<double>(std::abs(expected[i][1]));
        REQUIRE(std::abs(double{results[i].y} - cross) <= 1e-6 * cross);
        REQUIRE(std::abs(double{results[i].w} - dot) <= 1e-6 * dot);
    }
}

TEST_CASE("the next node to the right is the one that complete trees have") {
    OnePixel shader({tree}, 1, "result.x = float(next_right(uint(input0.x)));\n");
    std::vector<vec4> values;
    for (int node = 1; node < 5000; ++node)
        values.emplace_back(static_cast<float>(node), 0, 0, 0);
    const std::vector<vec4> results = shader.run(values);
    for (uint32_t node = 1; node < 5000; ++node)
        REQUIRE(results[node - 1].x == static_cast<float>(bvh::next_right(node)));
}

TEST_CASE("distances from segments of any length are good to a quantum") {
    // A point and one end in the first two inputs, the other end in the last two.
    OnePixel shader({strokes}, 4,
                    read_integers +
                        "ivec4 other = ivec4(input2) * 65536 + ivec4(input3);\n"
                        "result.x = sqrt(distance2(whole.xy, whole.zw, other.xy));\n");
    Dice dice(2);
    std::vector<vec4> values;
    std::vector<double> expected;
    for (int i = 0; i < 20000; ++i) {
        const int32_t most = i % 2 == 0 ? 500000 : 1 << 29;
        int32_t ends[4] = {dice.up_to(most), dice.up_to(most), dice.up_to(most), dice.up_to(most)};
        const double share = dice.up_to(1000) / 800.0;
        const int32_t aside = i % 3 == 0 ? 3 : 5000;
        const auto near = [&](int k) {
            return static_cast<int32_t>(ends[k] + share * (double(ends[k + 2]) - ends[k])) +
                   dice.up_to(aside);
        };
        const int32_t point[4] = {near(0), near(1), ends[0], ends[1]};
        const int32_t other[4] = {ends[2], ends[3], 0, 0};
        add_case(values, point);
        add_case(values, other);
        const double dx = double(ends[2]) - ends[0], dy = double(ends[3]) - ends[1];
        const double px = double(point[0]) - ends[0], py = double(point[1]) - ends[1];
        const double t = std::clamp((px * dx + py * dy) / std::max(dx * dx + dy * dy, 1.0), 0.0, 1.0);
        expected.push_back(std::hypot(px - t * dx, py - t * dy));
    }
    const std::vector<vec4> results = shader.run(values);
    for (size_t i = 0; i < results.size(); ++i) {
        INFO("case " << i);
        REQUIRE(std::abs(double{results[i].x} - expected[i]) <= 0.2 + 1e-6 * expected[i]);
    }
}

TEST_CASE("turns of a hatch are counted with 64 bits") {
    OnePixel shader({quad_trees}, 4,
                    read_integers +
                        "ivec4 other = ivec4(input2) * 65536 + ivec4(input3);\n"
                        "uint phase = turned(uvec2(whole.xy), uint(other.x));\n"
                        "result.xy = vec2(phase >> 16, phase & 65535u);\n",
                    {"HATCHES"});
    Dice dice(6);
    std::vector<vec4> values;
    std::vector<uint32_t> expected;
    for (int i = 0; i < 5000; ++i) {
        const int32_t step[4] = {dice.up_to(INT32_MAX), dice.up_to(INT32_MAX), 0, 0};
        const int32_t count[4] = {std::abs(dice.up_to(1 << 30)), 0, 0, 0};
        add_case(values, step);
        add_case(values, count);
        const uint64_t turn = uint64_t{static_cast<uint32_t>(step[0])} << 32 | static_cast<uint32_t>(step[1]);
        expected.push_back(static_cast<uint32_t>(turn * static_cast<uint64_t>(count[0]) >> 32));
    }
    const std::vector<vec4> results = shader.run(values);
    for (size_t i = 0; i < results.size(); ++i) {
        REQUIRE(results[i].x == static_cast<float>(expected[i] >> 16));
        REQUIRE(results[i].y == static_cast<float>(expected[i] & 65535));
    }
}

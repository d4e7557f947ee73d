// The shader functions of distance fields, a pixel a case.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "one_pixel.h"

using namespace decalgl;
using glm::vec4;
using test::OnePixel;

namespace {

// The share of the unit square where n . q <= d, by many samples.
double area(double d, double nx, double ny) {
    constexpr int side = 400;
    int inside = 0;
    for (int i = 0; i < side; ++i)
        for (int k = 0; k < side; ++k)
            inside += nx * ((i + 0.5) / side - 0.5) + ny * ((k + 0.5) / side - 0.5) <= d;
    return static_cast<double>(inside) / (side * side);
}

}  // namespace

TEST_CASE("half planes and strips cover their exact share of a pixel") {
    OnePixel shader({"technique/distance_field/half_plane_area.glsl"}, 1,
                    "result.x = half_plane_area(input0.x, input0.zw);\n"
                    "result.y = strip_area(abs(input0.x), input0.y, input0.zw);\n");
    std::mt19937 generator(3);
    std::uniform_real_distribution<float> distance(-1.0F, 1.0F), half_width(0.01F, 1.5F),
        angle(0.0F, 6.2831853F);
    std::vector<vec4> values{{0.25F, 0.1F, 1.0F, 0.0F}, {0.0F, 0.25F, 0.0F, -1.0F}};
    for (int i = 0; i < 120; ++i) {
        const float turn = angle(generator);
        values.emplace_back(distance(generator), half_width(generator), std::cos(turn), std::sin(turn));
    }
    const std::vector<vec4> found = shader.run(values);
    for (size_t i = 0; i < values.size(); ++i) {
        const vec4 v = values[i];
        const double away = std::abs(v.x);
        const double strip = area(v.y - away, v.z, v.w) - area(-v.y - away, v.z, v.w);
        CHECK(found[i].x == Approx(area(v.x, v.z, v.w)).margin(2e-3));
        CHECK(found[i].y == Approx(strip).margin(4e-3));
    }
}

TEST_CASE("ways across a line survive eight bits, and those of segments come first") {
    OnePixel shader({"shared/position.glsl", "shared/ray.glsl", "shared/stroke.glsl",
                     "technique/distance_field/field_values.glsl"},
                    1,
                    "float value = packed_turn(input0.x, input0.y > 0.0);\n"
                    "result.xy = unpacked_turn(round(255.0 * value) / 255.0);\n"
                    "result.z = value;\n");
    std::vector<vec4> values;
    for (int i = 0; i < 200; ++i)
        values.emplace_back(static_cast<float>(i) / 200.0F, i % 2 == 0 ? 1.0F : 0.0F, 0.0F, 0.0F);
    const std::vector<vec4> found = shader.run(values);
    for (size_t i = 0; i < values.size(); ++i) {
        const double turn = 6.2831853 * double{values[i].x};
        CHECK(found[i].x == Approx(std::cos(turn)).margin(0.03));
        CHECK(found[i].y == Approx(std::sin(turn)).margin(0.03));
        CHECK((found[i].z >= 0.5F) == (values[i].y > 0.0F));
    }
}

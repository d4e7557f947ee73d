// The shader functions of static decals, each against double precision on the CPU.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <random>

#include "one_pixel.h"
#include "technique/half_planes.h"
#include "technique/static_decals/bucket_grid.h"

using namespace decalgl;
using glm::vec4;
using test::OnePixel;

namespace {

const std::string cells = "technique/static_decals/cells.glsl";
const std::string point = "technique/static_decals/point.glsl";
const std::string area = "technique/static_decals/area.glsl";
constexpr int level = COARSEST_LEVEL;
constexpr int size = 1 << (BUCKET_BITS - level);  // of a cell, in quanta

class Dice {
public:
    explicit Dice(unsigned seed) : generator_(seed) {}

    float whole(int low, int high) {
        return static_cast<float>(std::uniform_int_distribution<int>(low, high)(generator_));
    }
    // A multiple of 1/8, which float32 holds without rounding.
    float eighth(int low, int high) { return whole(8 * low, 8 * high) / 8.0F; }
    double real(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(generator_);
    }

    // A ring's edge inside the cell, in any direction; some start or end on the left border.
    vec4 ring_edge() {
        vec4 edge(whole(0, size), whole(0, size), whole(0, size), whole(0, size));
        if (whole(0, 3) == 0.0F)
            edge.x = 0.0F;
        else if (whole(0, 3) == 0.0F)
            edge.z = 0.0F;
        return edge;
    }

private:
    std::mt19937 generator_;
};

vec4 upwards(vec4 edge) {
    return edge.y <= edge.w ? edge : vec4(edge.z, edge.w, edge.x, edge.y);
}

// Quanta from the edge's line, positive to the right of the way up.
double side_of(vec4 edge, double x, double y) {
    const vec4 up = upwards(edge);
    const double dx = double(up.z) - double(up.x), dy = double(up.w) - double(up.y);
    return ((x - double(up.x)) * dy - (y - double(up.y)) * dx) / std::max(std::hypot(dx, dy), 1e-9);
}

bool crosses_walk(vec4 edge, double x, double y) {
    const vec4 up = upwards(edge);
    const bool on_row = double(up.y) <= y && y < double(up.w) && side_of(edge, x, y) >= 0.0;
    const bool leaves = (edge.x == 0.0F) != (edge.z == 0.0F);
    const bool on_border = leaves && double(edge.x == 0.0F ? edge.y : edge.w) <= y;
    return on_row != on_border;
}

double distance_to(vec4 edge, double x, double y) {
    const double dx = double(edge.z) - double(edge.x), dy = double(edge.w) - double(edge.y);
    const double px = x - double(edge.x), py = y - double(edge.y);
    const double length2 = dx * dx + dy * dy;
    const double t = length2 > 0.0 ? std::clamp((px * dx + py * dy) / length2, 0.0, 1.0) : 0.0;
    return std::hypot(px - t * dx, py - t * dy);
}

}  // namespace

TEST_CASE("crosses_walk counts what the walk from the corner crosses, in either direction of an edge") {
    OnePixel shader({point}, 2, R"(
        vec2 place = input1.xy, from = place - input0.xy, to = place - input0.zw;
        result.xy = vec2(crosses_walk(from, to, place), crosses_walk(to, from, place));
    )",
                    {"RINGS"});
    Dice dice(1);
    std::vector<vec4> values;
    for (int i = 0; i < 20000; ++i) {
        const vec4 edge = dice.ring_edge();
        vec4 at(dice.eighth(0, size), dice.eighth(0, size), 0, 0);
        // Level with an end: counted once for two edges that meet there.
        if (i % 4 == 0)
            at.y = i % 8 == 0 ? edge.y : edge.w;
        values.insert(values.end(), {edge, at});
    }
    const std::vector<vec4> results = shader.run(values);
    int turned = 0;
    for (size_t i = 0; i < results.size(); ++i) {
        const vec4 edge = values[2 * i], at = values[2 * i + 1];
        REQUIRE(results[i].x == results[i].y);
        if (std::abs(side_of(edge, double(at.x), double(at.y))) < 0.02)
            continue;
        INFO(edge.x << " " << edge.y << " " << edge.z << " " << edge.w << " at " << at.x << " " << at.y);
        REQUIRE((results[i].x == 1.0F) == crosses_walk(edge, double(at.x), double(at.y)));
        turned += results[i].x == 1.0F;
    }
    CHECK(turned > 2000);
}

TEST_CASE("within_stroke is the distance to the segment, ends and points included") {
    OnePixel shader({point}, 2, R"(
        vec2 from = input1.xy - input0.xy, to = input1.xy - input0.zw;
        result.x = float(within_stroke(from, from, false, input1.z) || within_stroke(from, to, true, input1.z));
    )",
                    {"LINES"});
    Dice dice(2);
    std::vector<vec4> values;
    for (int i = 0; i < 20000; ++i) {
        constexpr int most = COORDINATE_SPAN - 1;
        vec4 edge(dice.whole(0, most), dice.whole(0, most), dice.whole(0, most), dice.whole(0, most));
        if (i % 3 == 0) {  // short, and in part of no length
            edge.z = std::min(edge.x + dice.whole(0, 3), float(most));
            edge.w = std::min(edge.y + dice.whole(0, 3), float(most));
        }
        const double half_width = std::exp2(dice.real(-4.0, 13.0));
        const double along = dice.real(-0.2, 1.2), angle = dice.real(0.0, 6.3),
                     away = half_width * dice.real(0.9, 1.1);
        const double x = double(edge.x) + along * double(edge.z - edge.x) + away * std::cos(angle);
        const double y = double(edge.y) + along * double(edge.w - edge.y) + away * std::sin(angle);
        values.insert(values.end(), {edge, vec4(x, y, half_width * half_width, 0)});
    }
    const std::vector<vec4> results = shader.run(values);
    int inside = 0;
    for (size_t i = 0; i < results.size(); ++i) {
        const vec4 edge = values[2 * i], at = values[2 * i + 1];
        const double distance = distance_to(edge, double(at.x), double(at.y));
        const double half_width = std::sqrt(double(at.z));
        if (std::abs(distance - half_width) < 0.02)
            continue;
        REQUIRE((results[i].x == 1.0F) == (distance < half_width));
        inside += results[i].x == 1.0F;
    }
    CHECK(inside > 3000);
}

TEST_CASE("what an edge decides for an area agrees with its samples one by one") {
    const std::string body = R"(
        Group group = group_of(LINE_OR_RING, 8192.0, input1.xy, mat2(input2.xy, input2.zw));
        group.half_width = input1.z;
        vec2 from = group.at - (input0.xy + 8192.0), to = group.at - (input0.zw + 8192.0);
        uint alike = ALIKE;
        group.covered = no_samples;
        group.beyond = all_samples;
        MASK;
        uvec2 mask = group.covered;
        uvec2 single = no_samples;
        for (int i = 0; i < sample_count; ++i) {
            vec2 step = group.foot * sample_offsets[i];
            single |= sample_if(ONE, i);
        }
        bool agrees = alike == for_each || count_of(uvec2(alike) ^ mask) <= 2;
        result = vec4(count_of(mask), count_of(mask ^ single), float(agrees), float(alike != for_each));
    )";
    const auto filled = [&](std::vector<std::pair<std::string, std::string>> words) {
        std::string text = body;
        for (const auto& [word, replacement] : words)
            text.replace(text.find(word), word.size(), replacement);
        return text;
    };
    Dice dice(3);
    std::vector<vec4> values;
    for (int i = 0; i < 20000; ++i) {
        const double foot = std::exp2(dice.real(3.0, 11.0));
        const auto side = [&] { return dice.real(-foot, foot); };
        vec4 edge = dice.ring_edge();
        if (i % 16 == 0)
            edge = vec4(edge.x, edge.y, edge.x, edge.y);
        const double along = dice.real(-0.1, 1.1), half_width = foot * dice.real(0.05, 3.0);
        const double x = double(edge.x) + along * double(edge.z - edge.x) + foot * dice.real(-3.0, 3.0);
        const double y = double(edge.y) + along * double(edge.w - edge.y) + foot * dice.real(-3.0, 3.0);
        values.insert(values.end(), {edge, vec4(x, y, half_width, 0), vec4(side(), side(), side(), side())});
    }
    test::test_context();
    const MemoryAccount account;
    const auto table = gl::TextureBuffer::from(account, "half planes", GL_RG32UI, make_half_planes());
    const auto check = [&](OnePixel shader) {
        shader.program().set("half_planes", 1);
        table.bind(1);
        double different = 0.0, total = 0.0, alike = 0.0, uniform = 0.0;
        for (const vec4& result : shader.run(values)) {
            // Where samples lie unevenly, some near an edge stand in for others.
            REQUIRE(result.y <= 12.0F);
            REQUIRE(result.z == 1.0F);
            different += double(result.y);
            total += double(result.x);
            alike += double(result.w);
            uniform += result.x == 0.0F || result.x == 64.0F;
        }
        CHECK(total > 64.0 * 1000);
        CHECK(different < 0.05 * total);
        CHECK(alike > 2000.0);
        CHECK(alike > 0.85 * uniform);
    };
    check(OnePixel(
        {area}, 3,
        filled({{"LINE_OR_RING", "LINE"},
                {"ALIKE", "alike_in_stroke(group, from, to)"},
                {"MASK", "add_edge(group, from, to, true); add_edge(group, to, to, false)"},
                {"ONE",
                 "(within_stroke(from + step, from + step, false, group.half_width * group.half_width) || "
                 "within_stroke(from + step, to + step, true, group.half_width * group.half_width))"}}),
        {"LINES"}));
    check(OnePixel({area}, 3,
                   filled({{"LINE_OR_RING", "0u"},
                           {"ALIKE", "alike_in_crossing(crossing_of(group, from, to))"},
                           {"MASK", "group.covered = crossing_mask(crossing_of(group, from, to))"},
                           {"ONE",
                            "((input0.x == 0.0) != (input0.z == 0.0) && "
                            "(input0.x == 0.0 ? from.y : to.y) + step.y >= 0.0) != "
                            "crosses_walk(from + step, to + step, vec2(1e9))"}}),
                   {"RINGS"}));
}

TEST_CASE("a half plane has its share of the samples, and its opposite the others") {
    test::test_context();
    const MemoryAccount account;
    const auto table = gl::TextureBuffer::from(account, "half planes", GL_RG32UI, make_half_planes());
    OnePixel shader({area}, 1, R"(
        Direction there = direction_of(input0.xy), back = direction_of(-input0.xy);
        uvec2 samples = samples_beyond(there, input0.z), others = samples_beyond(back, -input0.z);
        uvec2 fewer = samples_beyond(there, input0.z - 0.1 * length(input0.xy));
        result = vec4(count_of(samples), count_of(samples & others), count_of(~(samples | others)),
                      count_of(fewer & ~samples));
    )",
                    {"RINGS"});
    shader.program().set("half_planes", 1);
    table.bind(1);
    Dice dice(7);
    std::vector<vec4> values;
    for (int i = 0; i < 5000; ++i) {
        const double angle = dice.real(0.0, 6.3), size = std::exp2(dice.real(-5.0, 12.0));
        const double a = size * std::cos(angle), b = size * std::sin(angle);
        values.push_back({a, b, (std::abs(a) + std::abs(b)) * dice.real(-0.55, 0.55), 0});
    }
    const std::vector<vec4> results = shader.run(values);
    for (size_t i = 0; i < values.size(); ++i) {
        // Columns of the pixel, each cut at one height.
        double share = 0.0;
        constexpr int columns = 1000;
        for (int column = 0; column < columns; ++column) {
            const double x = (column + 0.5) / columns - 0.5;
            const double height = -(double(values[i].x) * x + double(values[i].z)) / double(values[i].y);
            const double above = std::clamp(0.5 - height, 0.0, 1.0);
            share += (values[i].y > 0.0F ? above : 1.0 - above) / columns;
        }
        REQUIRE(std::abs(double(results[i].x) / 64.0 - share) <= 0.0125);
        REQUIRE(results[i].y == 0.0F);
        REQUIRE(results[i].z == 0.0F);
        REQUIRE(results[i].w == 0.0F);
    }
}

TEST_CASE("polygons around a vertex share the samples out between them") {
    test::test_context();
    const MemoryAccount account;
    const auto table = gl::TextureBuffer::from(account, "half planes", GL_RG32UI, make_half_planes());
    // Three edges from one vertex, each run through in both directions by the polygons on its two sides.
    OnePixel shader({area}, 3, R"(
        Group group = group_of(0u, 8192.0, input2.xy, mat2(input2.z, 0.0, input2.w, input2.z));
        vec2 middle = group.at - (input0.xy + 8192.0);
        vec2 a = group.at - (input0.zw + 8192.0), b = group.at - (input1.xy + 8192.0);
        vec2 c = group.at - (input1.zw + 8192.0);
        uvec2 ab = crossing_mask(crossing_of(group, a, middle)) ^ crossing_mask(crossing_of(group, middle, b));
        uvec2 bc = crossing_mask(crossing_of(group, b, middle)) ^ crossing_mask(crossing_of(group, middle, c));
        uvec2 ca = crossing_mask(crossing_of(group, c, middle)) ^ crossing_mask(crossing_of(group, middle, a));
        result = vec4(count_of(ab ^ bc ^ ca), count_of(ab), count_of(bc), count_of(ca));
    )",
                    {"RINGS"});
    shader.program().set("half_planes", 1);
    table.bind(1);
    Dice dice(8);
    std::vector<vec4> values;
    for (int i = 0; i < 5000; ++i) {
        const vec4 first = dice.ring_edge(), second = dice.ring_edge();
        const double foot = std::exp2(dice.real(3.0, 11.0));
        values.insert(values.end(), {first, second,
                                     vec4(double(first.x) + foot * dice.real(-0.7, 0.7),
                                          double(first.y) + foot * dice.real(-0.7, 0.7), foot,
                                          foot * dice.real(-1.0, 1.0))});
    }
    int partly = 0;
    for (const vec4& result : shader.run(values)) {
        REQUIRE(result.x == 0.0F);
        partly += result.y > 0.0F && result.y < 64.0F;
    }
    CHECK(partly > 2000);
}

TEST_CASE("on_lattice counts quanta from the grid, whatever the size of a block") {
    const int shift = GENERATE(-6, -1, 0, 3, 12);
    const double block_size = GENERATE(0.25, 32.0);
    const double quantum = block_size * std::exp2(-shift);
    const int64_t first_x = -7 * (int64_t{1} << 20), first_y = 12 * (int64_t{1} << 20);
    OnePixel shader({cells}, 1, R"(
        LatticePosition found = on_lattice(Position(ivec2(input0.xy), input0.zw));
        result = vec4(vec2(found.quantum), found.fraction);
    )",
                    {"RINGS"});
    shader.program().set("block_shift", shift);
    shader.program().set("quanta_per_metre", static_cast<float>(1.0 / quantum));
    shader.program().set("first_quantum", glm::ivec2(first_x, first_y));
    const int64_t blocks = int64_t{1} << std::max(-shift, 0);
    shader.program().set("first_block", glm::ivec2(first_x * blocks, first_y * blocks));
    Dice dice(5);
    std::vector<vec4> values;
    for (int i = 0; i < 3000; ++i) {
        const auto offset = [&] {
            const auto any = static_cast<float>(dice.real(0.0, block_size));
            return i % 5 == 0 ? 0.0F : std::min(any, std::nextafter(static_cast<float>(block_size), 0.0F));
        };
        const auto block = [&](int64_t first) {
            const double quanta = static_cast<double>(first) + double(dice.whole(0, 1 << 23));
            return std::floor(quanta * std::exp2(-shift));
        };
        values.push_back({block(first_x), block(first_y), offset(), offset()});
    }
    const std::vector<vec4> results = shader.run(values);
    for (size_t i = 0; i < values.size(); ++i) {
        for (int axis = 0; axis < 2; ++axis) {
            const double at = (double(values[i][axis]) * block_size + double(values[i][axis + 2])) / quantum;
            const double first = static_cast<double>(axis == 0 ? first_x : first_y);
            const double fraction = double(results[i][axis + 2]);
            REQUIRE((fraction >= 0.0 && fraction < 1.0));
            REQUIRE(std::abs(first + double(results[i][axis]) + fraction - at) <= 1.0 / 1024);
        }
    }
}

TEST_CASE("cell_at finds the cell of a place, and an empty one outside the grid") {
    OnePixel shader({cells}, 1, R"(
        Cell cell = cell_at(ivec2(input0.xy));
        result = vec4(vec2(cell.corner), float(cell.bits), float(cell.entry));
    )",
                    {"RINGS"});
    // Three buckets by two: levels 0, 3, 4 and 0, 0, 6; entries count cells.
    const std::vector<int> levels{0, 3, 4, 0, 0, 6};
    std::vector<uint32_t> buckets, entries;
    for (const int one : levels) {
        buckets.push_back(static_cast<uint32_t>(entries.size()) << LEVEL_BITS | static_cast<uint32_t>(one));
        for (int i = 0; i < 1 << (2 * one); ++i)
            entries.push_back(static_cast<uint32_t>(entries.size()) + 1);
    }
    const MemoryAccount account;
    const auto bucket_buffer = gl::TextureBuffer::from(account, "buckets", GL_R32UI, buckets);
    const auto cell_buffer = gl::TextureBuffer::from(account, "cells", GL_R32UI, entries);
    shader.program().set("bucket_entries", 1);
    bucket_buffer.bind(1);
    shader.program().set("cell_entries", 2);
    cell_buffer.bind(2);
    shader.program().set("grid_size", glm::ivec2(3, 2));
    Dice dice(6);
    std::vector<vec4> values;
    for (int i = 0; i < 5000; ++i)
        values.push_back({dice.whole(-BUCKET_QUANTA, 4 * BUCKET_QUANTA),
                          dice.whole(-BUCKET_QUANTA, 3 * BUCKET_QUANTA), 0, 0});
    const std::vector<vec4> results = shader.run(values);
    for (size_t i = 0; i < values.size(); ++i) {
        const int x = static_cast<int>(values[i].x), y = static_cast<int>(values[i].y);
        const int column = x >> BUCKET_BITS, row = y >> BUCKET_BITS;
        if (column < 0 || row < 0 || column >= 3 || row >= 2) {
            REQUIRE(results[i].w == float(EMPTY_LIST));
            continue;
        }
        const uint32_t bucket = buckets[static_cast<size_t>(row * 3 + column)];
        const int bits = cell_bits(static_cast<int>(bucket & ((1U << LEVEL_BITS) - 1)));
        const int inside = BUCKET_QUANTA - 1;
        const uint32_t cell =
            static_cast<uint32_t>((y & inside) >> bits << (BUCKET_BITS - bits) | (x & inside) >> bits);
        REQUIRE(results[i].x == float(x >> bits << bits));
        REQUIRE(results[i].y == float(y >> bits << bits));
        REQUIRE(results[i].z == float(bits));
        REQUIRE(results[i].w == float((bucket >> LEVEL_BITS) + cell + 1));
    }
}

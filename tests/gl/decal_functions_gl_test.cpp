// The shader functions of static decals, each against double precision on the CPU.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <random>

#include "one_pixel.h"
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
        uint mask = MASK;
        uint single = 0u;
        for (int i = 0; i < sample_count; ++i) {
            vec2 step = group.foot * sample_offsets[i];
            single |= uint(ONE) << i;
        }
        bool agrees = alike == for_each || bitCount(alike ^ mask) <= 1;
        result = vec4(bitCount(mask), bitCount(mask ^ single), float(agrees), float(alike != for_each));
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
    const auto check = [&](OnePixel shader) {
        double different = 0.0, total = 0.0, alike = 0.0, uniform = 0.0;
        for (const vec4& result : shader.run(values)) {
            // Only a sample that lies on the edge itself, to float32, may go either way.
            REQUIRE(result.y <= 1.0F);
            REQUIRE(result.z == 1.0F);
            different += double(result.y);
            total += double(result.x);
            alike += double(result.w);
            uniform += result.x == 0.0F || result.x == 32.0F;
        }
        CHECK(total > 32.0 * 1000);
        CHECK(different < 1e-4 * total);
        CHECK(alike > 2000.0);
        CHECK(alike > 0.85 * uniform);
    };
    check(OnePixel(
        {area}, 3,
        filled({{"LINE_OR_RING", "LINE"},
                {"ALIKE", "alike_in_stroke(group, from, to)"},
                {"MASK", "stroke_mask(group, from, to)"},
                {"ONE",
                 "(within_stroke(from + step, from + step, false, group.half_width * group.half_width) || "
                 "within_stroke(from + step, to + step, true, group.half_width * group.half_width))"}}),
        {"LINES"}));
    check(OnePixel({area}, 3,
                   filled({{"LINE_OR_RING", "0u"},
                           {"ALIKE", "alike_in_crossing(crossing_of(group, from, to))"},
                           {"MASK", "crossing_mask(crossing_of(group, from, to))"},
                           {"ONE",
                            "((input0.x == 0.0) != (input0.z == 0.0) && "
                            "(input0.x == 0.0 ? from.y : to.y) + step.y >= 0.0) != "
                            "crosses_walk(from + step, to + step, vec2(1e9))"}}),
                   {"RINGS"}));
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

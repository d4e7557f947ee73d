// The shader functions of static decals, each against double precision on the CPU.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <random>

#include "one_pixel.h"
#include "technique/static_decals/cell_stream.h"

using namespace decalgl;
using glm::vec4;
using test::OnePixel;

namespace {

const std::string cells = "technique/static_decals/cells.glsl";
const std::string point = "technique/static_decals/point.glsl";
const std::string area = "technique/static_decals/area.glsl";
constexpr double far_border = 1e9;

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

    // A ring piece inside the cell, from its lower to its upper end; some start or end on the left border.
    vec4 ring_piece() {
        const int low = COORDINATE_BIAS, high = COORDINATE_BIAS + CELL_QUANTA;
        vec4 piece(whole(low, high), whole(low, high), whole(low, high), whole(low, high));
        if (whole(0, 3) == 0.0F) {
            piece.x = float(low);
        } else if (whole(0, 3) == 0.0F) {
            piece.z = float(low);
        }
        if (piece.y > piece.w) {
            piece = {piece.z, piece.w, piece.x, piece.y};
        }
        return piece;
    }

private:
    std::mt19937 generator_;
};

double border_crossing(vec4 piece) {
    const bool starts = piece.x == float(COORDINATE_BIAS), ends = piece.z == float(COORDINATE_BIAS);
    return starts == ends ? far_border : static_cast<double>(starts ? piece.y : piece.w);
}

// Quanta from the piece's line, positive to its right.
double side_of(vec4 piece, double x, double y) {
    const double dx = double(piece.z) - double(piece.x), dy = double(piece.w) - double(piece.y);
    return ((x - double(piece.x)) * dy - (y - double(piece.y)) * dx) / std::max(std::hypot(dx, dy), 1e-9);
}

bool crosses_walk(vec4 piece, double x, double y) {
    const bool on_row = double(piece.y) <= y && y < double(piece.w) && side_of(piece, x, y) >= 0.0;
    return on_row != (border_crossing(piece) <= y);
}

double distance_to(vec4 piece, double x, double y) {
    const double dx = double(piece.z) - double(piece.x), dy = double(piece.w) - double(piece.y);
    const double px = x - double(piece.x), py = y - double(piece.y);
    const double length2 = dx * dx + dy * dy;
    const double t = length2 > 0.0 ? std::clamp((px * dx + py * dy) / length2, 0.0, 1.0) : 0.0;
    return std::hypot(px - t * dx, py - t * dy);
}

}  // namespace

TEST_CASE("border_crossing tells where a piece leaves the left border") {
    OnePixel shader({cells}, 1, "result.x = border_crossing(input0);\n", {"RINGS"});
    const float left = COORDINATE_BIAS, inner = left + 5.0F;
    const std::vector<vec4> results = shader.run(
        {{left, 20, inner, 30}, {inner, 20, left, 30}, {inner, 20, inner, 30}, {left, 20, left, 30}});
    CHECK(results[0].x == 20.0F);
    CHECK(results[1].x == 30.0F);
    CHECK(results[2].x > 65535.0F);
    CHECK(results[3].x > 65535.0F);
}

TEST_CASE("crosses_walk counts what the walk from the corner crosses") {
    OnePixel shader({point}, 2, "result.x = float(crosses_walk(input0, input1.xy));\n", {"RINGS"});
    Dice dice(1);
    std::vector<vec4> values;
    for (int i = 0; i < 20000; ++i) {
        const vec4 piece = dice.ring_piece();
        vec4 at(dice.eighth(COORDINATE_BIAS, COORDINATE_BIAS + CELL_QUANTA),
                dice.eighth(COORDINATE_BIAS, COORDINATE_BIAS + CELL_QUANTA), 0, 0);
        if (i % 4 == 0) {
            at.y = i % 8 == 0 ? piece.y
                              : piece.w;  // level with an end: counted once for two pieces that meet there
        }
        values.insert(values.end(), {piece, at});
    }
    const std::vector<vec4> results = shader.run(values);
    int turned = 0;
    for (size_t i = 0; i < results.size(); ++i) {
        const vec4 piece = values[2 * i], at = values[2 * i + 1];
        const double x = double(at.x), y = double(at.y);
        if (std::abs(side_of(piece, x, y)) < 0.02) {
            continue;
        }
        INFO(piece.x << " " << piece.y << " " << piece.z << " " << piece.w << " at " << x << " " << y);
        REQUIRE((results[i].x == 1.0F) == crosses_walk(piece, x, y));
        turned += results[i].x == 1.0F;
    }
    CHECK(turned > 2000);
}

TEST_CASE("a point right below a cell's upper border meets the edges that end there") {
    // Coordinates of pieces are biased: adding the bias must not round the point onto the border.
    OnePixel shader({point}, 3, R"(
        CellPosition place = locate(Position(ivec2(0), input0.xy));
        Group group = Group(0u, false, 1.0, 0.0);
        result = vec4(float(meets(group, input1, place.local)), vec2(place.cell), 0.0);
    )",
                    {"RINGS"});
    shader.program().set("cell_shift", 0);
    shader.program().set("quanta_per_metre", static_cast<float>(CELL_QUANTA));
    shader.program().set("first_cell", glm::ivec2(0, 0));
    ViewBlock view{};
    view.base_offset.z = 1.0F;
    const float low = COORDINATE_BIAS, middle = low + CELL_QUANTA / 2, high = low + CELL_QUANTA;
    const float last = std::nextafter(1.0F, 0.0F);
    const vec4 upright(middle, low, middle, high), slanted(low, middle, high, high), none(0);
    const std::vector<vec4> results = shader.run({{0.9F, last, 0, 0},
                                                  upright,
                                                  none,  //
                                                  {0.1F, last, 0, 0},
                                                  upright,
                                                  none,  //
                                                  {last, 0.6F, 0, 0},
                                                  slanted,
                                                  none},
                                                 view);
    CHECK(results[0] == vec4(1, 0, 0, 0));
    CHECK(results[1] == vec4(0, 0, 0, 0));
    CHECK(results[2] == vec4(0, 0, 0, 0));  // the crossings of the border and of the row cancel
}

TEST_CASE("within_stroke is the distance to the segment, ends and points included") {
    OnePixel shader({point}, 2, "result.x = float(within_stroke(input0, input1.xy, input1.z));\n", {"LINES"});
    Dice dice(2);
    std::vector<vec4> values;
    std::vector<double> half_widths;
    for (int i = 0; i < 20000; ++i) {
        vec4 piece(dice.whole(0, COORDINATE_MAX), dice.whole(0, COORDINATE_MAX),
                   dice.whole(0, COORDINATE_MAX), dice.whole(0, COORDINATE_MAX));
        if (i % 3 == 0) {  // short, and in part of no length
            piece.z = std::min(piece.x + dice.whole(0, 3), float(COORDINATE_MAX));
            piece.w = std::min(piece.y + dice.whole(0, 3), float(COORDINATE_MAX));
        }
        const double half_width = std::exp2(dice.real(-4.0, 14.0));
        const double along = dice.real(-0.2, 1.2), angle = dice.real(0.0, 6.3),
                     away = half_width * dice.real(0.9, 1.1);
        const double x = double(piece.x) + along * double(piece.z - piece.x) + away * std::cos(angle);
        const double y = double(piece.y) + along * double(piece.w - piece.y) + away * std::sin(angle);
        values.insert(values.end(), {piece, vec4(x, y, half_width * half_width, 0)});
    }
    const std::vector<vec4> results = shader.run(values);
    int inside = 0;
    for (size_t i = 0; i < results.size(); ++i) {
        const vec4 piece = values[2 * i], at = values[2 * i + 1];
        const double distance = distance_to(piece, double(at.x), double(at.y));
        const double half_width = std::sqrt(double(at.z));
        if (std::abs(distance - half_width) < 0.02) {
            continue;
        }
        REQUIRE((results[i].x == 1.0F) == (distance < half_width));
        inside += results[i].x == 1.0F;
    }
    CHECK(inside > 3000);
}

TEST_CASE("the masks of an area agree with its samples one by one") {
    // Bits are compared in halves: a float holds 24 of them.
    const std::string body = R"(
        mat2 foot = mat2(input2.xy, input2.zw);
        uint mask = LINE_OR_RING;
        uint single = 0u;
        for (int i = 0; i < sample_count; ++i) {
            vec2 at = input1.xy + foot * sample_offsets[i];
            single |= uint(ONE_POINT) << i;
        }
        uint different = mask ^ single;
        result = vec4(bitCount(mask), bitCount(different), float(findLSB(different)), 0.0);
    )";
    const auto filled = [&](std::string mask, std::string one) {
        std::string text = body;
        text.replace(text.find("LINE_OR_RING"), 12, mask);
        text.replace(text.find("ONE_POINT"), 9, one);
        return text;
    };
    Dice dice(3);
    std::vector<vec4> strokes, rings;
    for (int i = 0; i < 20000; ++i) {
        const double size = std::exp2(dice.real(4.0, 12.0));
        const vec4 foot(dice.real(-size, size), dice.real(-size, size), dice.real(-size, size),
                        dice.real(-size, size));
        const vec4 piece = dice.ring_piece();
        const double along = dice.real(-0.1, 1.1), half_width = size * dice.real(0.05, 3.0);
        const double x = double(piece.x) + along * double(piece.z - piece.x) + size * dice.real(-3.0, 3.0);
        const double y = double(piece.y) + along * double(piece.w - piece.y) + size * dice.real(-3.0, 3.0);
        strokes.insert(strokes.end(), {piece, vec4(x, y, half_width * half_width, 0), foot});
        rings.insert(rings.end(), {piece, vec4(x, y, 0, 0), foot});
    }
    const auto check = [](const std::vector<vec4>& results) {
        double different = 0.0, total = 0.0;
        for (const vec4& result : results) {
            // Only a sample that lies on the edge itself, to float32, may go either way.
            REQUIRE(result.y <= 1.0F);
            different += double(result.y);
            total += double(result.x);
        }
        CHECK(total > 32.0 * 1000);
        CHECK(different < 1e-4 * total);
    };
    const std::string distance = R"((dot(at - input0.xy - clamp(dot(at - input0.xy, input0.zw - input0.xy) /
        max(dot(input0.zw - input0.xy, input0.zw - input0.xy), 1e-6), 0.0, 1.0) * (input0.zw - input0.xy),
        at - input0.xy - clamp(dot(at - input0.xy, input0.zw - input0.xy) /
        max(dot(input0.zw - input0.xy, input0.zw - input0.xy), 1e-6), 0.0, 1.0) * (input0.zw - input0.xy))
        <= input1.z))";
    OnePixel lines({area}, 3, filled("stroke_mask(input0, input1.xy, foot, input1.z)", distance), {"LINES"});
    check(lines.run(strokes));
    const std::string walk =
        R"(((input0.y <= at.y && at.y < input0.w && (at.x - input0.x) * (input0.w - input0.y) >=
        (at.y - input0.y) * (input0.z - input0.x)) != (border_crossing(input0) <= at.y)))";
    OnePixel polygons({area}, 3, filled("crossing_mask(input0, input1.xy, foot)", walk), {"RINGS"});
    check(polygons.run(rings));
}

TEST_CASE("every sample of an area belongs to one cell") {
    OnePixel shader({area}, 2, R"(
        mat2 foot = mat2(input1.xy, input1.zw);
        uint left = all_samples;
        uint taken = 0u;
        bool once = true;
        int turns = 0;
        while (left != 0u && turns < 40) {
            uint inside = samples_in_cell(input0.xy, foot, cell_of_sample(input0.xy, foot, findLSB(left)));
            once = once && (inside & taken) == 0u && (inside & left) != 0u;
            taken |= inside;
            left &= ~inside;
            ++turns;
        }
        result = vec4(float(once), float(bitCount(taken)), turns, 0.0);
    )",
                    {"RINGS"});
    Dice dice(4);
    std::vector<vec4> values;
    for (int i = 0; i < 5000; ++i) {
        const double size = std::exp2(dice.real(5.0, 17.0));
        values.push_back({dice.real(0, CELL_QUANTA), dice.real(0, CELL_QUANTA), 0, 0});
        values.push_back(
            {dice.real(-size, size), dice.real(-size, size), dice.real(-size, size), dice.real(-size, size)});
    }
    for (const vec4& result : shader.run(values)) {
        REQUIRE(result.x == 1.0F);
        REQUIRE(result.y == 32.0F);
    }
}

TEST_CASE("locate finds the cell of a position and the place in it") {
    const int shift = GENERATE(-6, -1, 0, 3, 7);
    const double block_size = GENERATE(0.25, 32.0);
    const double cell_size = block_size * std::exp2(shift);
    const double quantum = cell_size / CELL_QUANTA;
    const glm::ivec2 first_cell(-7, 12);
    const std::string body = R"(
        Position position = Position(ivec2(input0.xy), input0.zw);
        CellPosition found = locate(position);
        result = vec4(vec2(found.cell), found.local);
    )";
    OnePixel shader({cells}, 1, body, {"RINGS"});
    shader.program().set("cell_shift", shift);
    shader.program().set("quanta_per_metre", static_cast<float>(1.0 / quantum));
    shader.program().set("first_cell", first_cell);
    ViewBlock view{};
    view.base_offset.z = static_cast<float>(block_size);
    Dice dice(5);
    std::vector<vec4> values;
    for (int i = 0; i < 3000; ++i) {
        const auto offset = [&] {
            const auto any = static_cast<float>(dice.real(0.0, block_size));
            return i % 5 == 0 ? 0.0F : std::min(any, std::nextafter(static_cast<float>(block_size), 0.0F));
        };
        values.push_back({dice.whole(-2000, 2000), dice.whole(-2000, 2000), offset(), offset()});
    }
    const std::vector<vec4> results = shader.run(values, view);
    for (size_t i = 0; i < values.size(); ++i) {
        for (int axis = 0; axis < 2; ++axis) {
            const double at = double(values[i][axis]) * block_size + double(values[i][axis + 2]);
            const double local = double(results[i][axis + 2]);
            const double cell = double(results[i][axis]) + first_cell[axis];
            REQUIRE(local >= 0.0);
            // Offsets in a block are exact; their sum over a cell of many blocks rounds to a 512th of a quantum. At the
            // upper border of a cell a position is kept a 128th inside.
            const bool at_border = local >= CELL_QUANTA - 1.0 / 64;
            REQUIRE(local < CELL_QUANTA);
            REQUIRE(std::abs(cell * cell_size + local * quantum - at) <= (at_border   ? quantum / 64
                                                                          : shift > 0 ? quantum / 512
                                                                                      : 0.0));
        }
    }
}

TEST_CASE("cell_range is empty outside the grid") {
    OnePixel shader({cells}, 1, "result.xy = vec2(cell_range(ivec2(input0.xy)));\n", {"RINGS"});
    const MemoryAccount account;
    std::vector<uint32_t> starts(2 * BUCKET_CELLS + 1);
    for (size_t i = 0; i < starts.size(); ++i) {
        starts[i] = static_cast<uint32_t>(3 * i);
    }
    const gl::TextureBuffer texels = gl::TextureBuffer::from(account, "starts", GL_R32UI, starts);
    shader.program().set("cell_starts", 1);
    texels.bind(1);
    shader.program().set("grid_size", glm::ivec2(40, 20));
    shader.program().set("bucket_columns", 2);
    const std::vector<vec4> results = shader.run({{0, 0, 0, 0},
                                                  {0, 1, 0, 0},
                                                  {1, 0, 0, 0},
                                                  {32, 0, 0, 0},
                                                  {39, 19, 0, 0},
                                                  {40, 0, 0, 0},
                                                  {0, 20, 0, 0},
                                                  {-1, 0, 0, 0},
                                                  {0, -1, 0, 0}});
    const int side = 1 << BUCKET_BITS;
    const std::vector<int> cell_numbers{0, 1, side, BUCKET_CELLS, BUCKET_CELLS + 7 * side + 19};
    for (size_t i = 0; i < cell_numbers.size(); ++i) {
        CHECK(results[i].x == float(3 * cell_numbers[i]));
        CHECK(results[i].y == float(3 * cell_numbers[i] + 3));
    }
    for (size_t i = cell_numbers.size(); i < results.size(); ++i) {
        CHECK(results[i].x == results[i].y);
    }
}

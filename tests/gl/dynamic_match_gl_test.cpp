// Terrain matching on the GPU against the same algorithm on the CPU (Zechmeister 2020, algorithm 3.1).
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "decalgl/core/progress.h"
#include "decalgl/terrain/heightfield.h"
#include "decalgl/vector/layer.h"
#include "gl/texture.h"
#include "gl_fixture.h"
#include "technique/dynamic_lines/line_set.h"
#include "technique/dynamic_lines/prefix_sum.h"

using namespace decalgl;

namespace {

constexpr int side = 40;
constexpr float hole = -2e30F;

Heightfield bumpy_ground(bool with_holes) {
    std::vector<float> heights;
    for (int i = 0; i < side * side; ++i)
        heights.push_back(with_holes && i % 37 == 5 ? std::numeric_limits<float>::quiet_NaN()
                                                    : 20.0F * std::sin(0.7F * static_cast<float>(i)));
    return {std::move(heights), side, side, 3e6, 5e6, 10.0, 12.0};
}

gl::Texture2D texture_of(const Heightfield& terrain, const MemoryAccount& memory) {
    std::vector<float> texels(terrain.heights().begin(), terrain.heights().end());
    for (float& texel : texels)
        texel = std::isnan(texel) ? hole : texel;
    gl::Texture2D texture = gl::Texture2D::create(memory, "heights", GL_R32F, side, side);
    texture.update(0, 0, 0, side, side, texels.data());
    return texture;
}

// Lines from far inside to far beyond the terrain, some closed, one a point.
Layer wandering_layer() {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> x(3e6 - 30.0, 3e6 + 420.0), y(5e6 - 500.0, 5e6 + 30.0);
    std::vector<double> coordinates;
    std::vector<int64_t> parts{0}, features{0};
    for (int line = 0; line < 60; ++line) {
        const size_t first = coordinates.size();
        for (int i = 0; i < 1 + line % 7; ++i)
            coordinates.insert(coordinates.end(), {x(random), y(random)});
        if (line % 3 == 0 && line % 7 > 2)
            coordinates.insert(coordinates.end(), {coordinates[first], coordinates[first + 1]});
        parts.push_back(static_cast<int64_t>(coordinates.size() / 2));
        features.push_back(static_cast<int64_t>(parts.size()) - 1);
    }
    Layer layer;
    layer.features = Features::own(FeatureKind::lines, coordinates, parts, features);
    layer.stroke.colors = {255, 0, 0, 255};
    layer.stroke.widths = {2.0};
    layer.stroke.units = WidthUnits::pixels;
    return layer;
}

// The plane of the triangle there; NaN where one of its samples is missing.
double ground_at(const Heightfield& terrain, double x, double y) {
    const double u = std::clamp((x - terrain.x0()) / terrain.dx(), 0.0, side - 1.0);
    const double v = std::clamp((terrain.y0() - y) / terrain.dy(), 0.0, side - 1.0);
    const int column = std::min(static_cast<int>(u), side - 2), row = std::min(static_cast<int>(v), side - 2);
    const auto at = [&](int r, int c) { return static_cast<double>(terrain.height(r, c)); };
    const double a = u - column, b = v - row;
    const double corner = at(row, column), opposite = at(row + 1, column + 1);
    if (b > a)
        return corner + a * (opposite - at(row + 1, column)) + b * (at(row + 1, column) - corner);
    return corner + a * (at(row, column + 1) - corner) + b * (opposite - at(row, column + 1));
}

std::unique_ptr<PreparedLines> prepared_on(const Heightfield& terrain) {
    const std::vector<Layer> layers{wandering_layer()};
    TechniqueInput input;
    input.layers = layers;
    input.terrain = &terrain;
    input.bounds = terrain.bounds();
    input.positions = PositionGrid::around(input.bounds);
    Progress progress;
    return prepare_lines(input, progress);
}

}  // namespace

TEST_CASE("lines are cut to half a sample and put on the drawn surface, as on the CPU") {
    test::test_context();
    const bool with_holes = GENERATE(false, true);
    const MemoryAccount memory;
    gl::ProgramLibrary programs;
    const Heightfield terrain = bumpy_ground(with_holes);
    const gl::Texture2D heights = texture_of(terrain, memory);
    const auto prepared = prepared_on(terrain);
    const MatchedLines matched = match_lines(*prepared, {&heights, &terrain}, memory, programs);
    const auto vertices = matched.vertices.buffer().read<MatchedVertex>();
    const auto lines = matched.lines.buffer().read<LineRecord>();
    REQUIRE(lines.size() == prepared->lines.size());
    const double longest = 5.0 / prepared->lattice.quantum;
    size_t next = 0, wrong = 0;
    for (size_t i = 0; i < lines.size(); ++i) {
        const LineRecord& source = prepared->lines[i];
        REQUIRE(lines[i].first == next);
        CHECK(lines[i].flags == source.flags);
        for (uint32_t k = 0; k < source.count; ++k) {
            const ivec2 from = prepared->vertices[source.first + k].place;
            const bool ends = k + 1 == source.count;
            const ivec2 to = ends ? from : prepared->vertices[source.first + k + 1].place;
            const glm::dvec2 way(to - from);
            const double length = glm::length(way);
            const int pieces = length > longest ? static_cast<int>(length / longest) + 1 : 1;
            for (int piece = 0; piece < pieces; ++piece, ++next) {
                const MatchedVertex& found = vertices[next];
                const double share = static_cast<double>(piece) / pieces;
                wrong += std::abs(found.place.x - (from.x + share * way.x)) > 1.0;
                wrong += std::abs(found.place.y - (from.y + share * way.y)) > 1.0;
                wrong += found.line != i;
                const double ground =
                    ground_at(terrain, matched.lattice.x_of(found.place), matched.lattice.y_of(found.place));
                // Beside a hole, neighbouring samples stand in: any height of the terrain.
                wrong += std::isnan(ground) ? !(std::abs(found.height) <= 20.0F)
                                            : std::abs(static_cast<double>(found.height) - ground) > 1e-3;
            }
        }
        CHECK(lines[i].count == next - lines[i].first);
    }
    CHECK(wrong == 0);
    CHECK(next == matched.vertex_count);
    CHECK(next > 1000);
}

TEST_CASE("prefix sums of all lengths are those of the CPU") {
    test::test_context();
    const MemoryAccount memory;
    gl::ProgramLibrary programs;
    std::mt19937 random(3);
    for (const uint32_t count : {1U, 2U, 127U, 128U, 129U, 16384U, 16385U, 100000U}) {
        std::vector<uint32_t> values(count);
        for (uint32_t& value : values)
            value = random() % 9;
        const gl::Buffer buffer = gl::Buffer::from(memory, "values", values);
        PrefixSum(count, memory).run(buffer, count, programs);
        const auto found = buffer.read<uint32_t>();
        uint32_t sum = 0;
        size_t wrong = 0;
        for (uint32_t i = 0; i < count; ++i) {
            wrong += found[i] != sum;
            sum += values[i];
        }
        CHECK(wrong == 0);
    }
}

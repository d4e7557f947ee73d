// Shadow volumes: pieces of strokes, closed meshes, groups of a colour and batches.
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

#include "technique/shadow_volumes/color_groups.h"
#include "technique/shadow_volumes/stroke_pieces.h"
#include "technique/shadow_volumes/volume_mesh.h"

using namespace decalgl;
using namespace decalgl::volume;

namespace {

constexpr double pi = 3.14159265358979323846;

Heightfield slope() {
    std::vector<float> heights;
    for (int row = 0; row < 11; ++row)
        for (int column = 0; column < 11; ++column)
            heights.push_back(static_cast<float>(7 * column - 3 * row));
    return {SharedArray<float>(heights), 11, 11, 0.0, 1000.0, 100.0, 100.0};
}

// Of a square of 1000 m, whatever a test puts into it.
struct Ground {
    Heightfield terrain = slope();
    Lattice lattice = Lattice::over(terrain.bounds());
    MemoryAccount memory;
    HeightRanges heights{terrain, 1, memory, "ground"};
};

LatticePoint at(const Ground& ground, double x, double y) {
    return rounded(ground.lattice.place(x, y));
}

// Each edge runs as often one way as the other, so nothing is open.
bool is_closed(const MeshedVolumes& meshes, const Volume& volume) {
    std::map<std::pair<uint16_t, uint16_t>, int> edges;
    for (uint32_t i = volume.first_corner; i < volume.first_corner + volume.corner_count; i += 3)
        for (uint32_t k = 0; k < 3; ++k) {
            const uint16_t from = meshes.corners[i + k], to = meshes.corners[i + (k + 1) % 3];
            ++edges[{from, to}];
            --edges[{to, from}];
        }
    return std::all_of(edges.begin(), edges.end(), [](const auto& edge) { return edge.second == 0; });
}

bool holds(const std::vector<Vector2>& piece, Vector2 p, double slack) {
    for (size_t i = 0; i < piece.size(); ++i) {
        const Vector2 a = piece[i], b = piece[(i + 1) % piece.size()];
        const Vector2 along{b.x - a.x, b.y - a.y};
        if (cross(along, {p.x - a.x, p.y - a.y}) < -slack * length(along))
            return false;
    }
    return true;
}

double distance_to(const std::vector<Vector2>& line, Vector2 p) {
    double nearest = INFINITY;
    for (size_t i = 0; i + 1 < line.size(); ++i) {
        const Vector2 along{line[i + 1].x - line[i].x, line[i + 1].y - line[i].y};
        const Vector2 from{p.x - line[i].x, p.y - line[i].y};
        const double share = std::clamp(dot(from, along) / dot(along, along), 0.0, 1.0);
        nearest = std::min(nearest, std::hypot(from.x - share * along.x, from.y - share * along.y));
    }
    return nearest;
}

// Squares of the map, each of two triangles, in colours of their own.
Layer squares(const std::vector<std::array<double, 3>>& places, const std::vector<uint8_t>& colors) {
    Layer layer;
    layer.name = "squares";
    std::vector<double> coordinates;
    std::vector<int64_t> part_offsets{0}, feature_offsets{0};
    layer.triangles.first_of = {0};
    for (const auto& [x, y, side] : places) {
        const double ring[] = {x, y, x + side, y, x + side, y + side, x, y + side};
        coordinates.insert(coordinates.end(), std::begin(ring), std::end(ring));
        part_offsets.push_back(part_offsets.back() + 4);
        feature_offsets.push_back(feature_offsets.back() + 1);
        for (const int corner : {0, 1, 2, 0, 2, 3}) {
            layer.triangles.coordinates.push_back(ring[2 * corner]);
            layer.triangles.coordinates.push_back(ring[2 * corner + 1]);
        }
        layer.triangles.first_of.push_back(layer.triangles.first_of.back() + 2);
    }
    layer.features = Features::own(FeatureKind::polygons, coordinates, part_offsets, feature_offsets);
    layer.fill.colors = colors;
    return layer;
}

std::unique_ptr<const PreparedVolumes> prepare(const Ground& ground, const Layer& layer) {
    TechniqueInput input;
    input.layers = Span(&layer, 1);
    input.terrain = &ground.terrain;
    input.bounds = ground.terrain.bounds();
    input.memory = ground.memory;
    Progress progress;
    return build_volumes(input, progress);
}

// The decals whose lids hold a point, for each group and batch that is drawn.
std::map<uint32_t, std::map<uint32_t, std::vector<uint32_t>>> counted(const PreparedVolumes& prepared,
                                                                      LatticePoint p) {
    std::map<uint32_t, std::map<uint32_t, std::vector<uint32_t>>> found;
    for (uint32_t b = 0; b < prepared.batches.size(); ++b) {
        const Batch& batch = prepared.batches[b];
        for (uint32_t i = batch.first_drawn; i < batch.first_drawn + batch.volume_count; ++i) {
            const Volume& volume = prepared.volumes[prepared.drawn[i]];
            if (volume.box.holds(p))
                found[batch.group][b].push_back(volume.decal);
        }
    }
    return found;
}

}  // namespace

TEST_CASE("pieces of a round stroke cover what is near the line, and nothing else") {
    std::mt19937 generator(3);
    std::uniform_real_distribution<double> place(0.0, 1000.0);
    const double half_width = 60.0, step = 10.0 * pi / 180.0;
    for (int turn = 0; turn < 20; ++turn) {
        std::vector<Vector2> line;
        for (int i = 0; i < 5; ++i)
            line.push_back({place(generator), place(generator)});
        std::vector<std::vector<Vector2>> pieces;
        cut_stroke(line, false, {half_width, Corner::round, Cap::round, 60.0, step},
                   [&](Span<const Vector2> corners) { pieces.emplace_back(corners.begin(), corners.end()); });
        for (int i = 0; i < 2000; ++i) {
            const Vector2 p{place(generator), place(generator)};
            const double distance = distance_to(line, p);
            const bool is_inside = std::any_of(pieces.begin(), pieces.end(),
                                               [&](const auto& piece) { return holds(piece, p, 1e-6); });
            if (distance < half_width * std::cos(0.5 * step) - 1e-3)
                REQUIRE(is_inside);
            if (distance > half_width + 1e-3)
                REQUIRE_FALSE(is_inside);
        }
    }
}

TEST_CASE("bars of a line that bends little share their edges") {
    const Ground ground;
    const StrokeShape shape{10.0 / ground.lattice.quantum, Corner::miter, Cap::butt, 10.0, 0.2};
    std::vector<Vector2> line;
    for (int i = 0; i <= 20; ++i)
        line.push_back(ground.lattice.place(100.0 + 40.0 * i, 500.0 + 30.0 * std::sin(0.3 * i)));
    MeshedVolumes meshes;
    VolumeMesher mesher(ground.lattice, ground.heights, meshes);
    cut_stroke(line, false, shape, [&](Span<const Vector2> corners) { mesher.add(corners); });
    mesher.finish(0);
    REQUIRE(meshes.volumes.size() == 1);
    CHECK(meshes.vertices.size() == 2 * line.size());
    CHECK(is_closed(meshes, meshes.volumes[0]));
}

TEST_CASE("meshes are closed whatever their triangles are, and hold the ground under them") {
    const Ground ground;
    std::mt19937 generator(4);
    std::uniform_real_distribution<double> place(-300.0, 1300.0);
    MeshedVolumes meshes;
    VolumeMesher mesher(ground.lattice, ground.heights, meshes);
    std::vector<LatticePoint> points;
    for (int i = 0; i < 12; ++i)
        points.push_back(at(ground, place(generator), place(generator)));
    std::uniform_int_distribution<size_t> any(0, points.size() - 1);
    for (uint32_t decal = 0; decal < 50; ++decal) {
        for (int i = 0; i < 6; ++i)
            mesher.add(Triangle{points[any(generator)], points[any(generator)], points[any(generator)]});
        mesher.finish(decal);
    }
    REQUIRE(meshes.volumes.size() > 40);
    const double step = ground.heights.step();
    for (const Volume& volume : meshes.volumes) {
        REQUIRE(is_closed(meshes, volume));
        for (uint32_t i = volume.first_corner; i < volume.first_corner + volume.lid_corners; ++i) {
            const VolumeVertex& vertex = meshes.vertices[volume.first_vertex + meshes.corners[i] / 2U];
            const HeightRange own =
                ground.heights.over(ground.lattice.bounds({vertex.x, vertex.y, vertex.x, vertex.y}));
            const double low = ground.heights.lowest() + step * (vertex.heights & 0xFFFFU);
            const double high = ground.heights.lowest() + step * (vertex.heights >> 16U);
            REQUIRE(low <= high);
            if (own.empty())
                continue;
            REQUIRE(low <= double{own.lowest} + 1e-4);
            REQUIRE(high >= double{own.highest} - 1e-4);
        }
    }
}

TEST_CASE("a mesh of more vertices than 16 bits name becomes several closed ones") {
    const Ground ground;
    MeshedVolumes meshes;
    VolumeMesher mesher(ground.lattice, ground.heights, meshes);
    constexpr int count = 40000;
    const auto rim = [&](int i) {
        const double angle = 2.0 * pi * i / count;
        return at(ground, 500.0 + 400.0 * std::cos(angle), 500.0 + 400.0 * std::sin(angle));
    };
    for (int i = 0; i < count; ++i)
        mesher.add(Triangle{at(ground, 500.0, 500.0), rim(i), rim(i + 1)});
    mesher.finish(7);
    REQUIRE(meshes.volumes.size() == 2);
    uint32_t lids = 0;
    for (const Volume& volume : meshes.volumes) {
        CHECK(volume.decal == 7);
        CHECK(is_closed(meshes, volume));
        lids += volume.lid_corners / 3;
    }
    CHECK(lids == count);
}

TEST_CASE("groups laid over each other are decals laid over each other, and batches can be counted") {
    const Ground ground;
    std::mt19937 generator(6);
    std::uniform_real_distribution<double> place(0.0, 900.0);
    std::vector<std::array<double, 3>> places;
    std::vector<uint8_t> colors;
    const bool is_translucent = GENERATE(false, true);
    for (int i = 0; i < 400; ++i) {
        places.push_back({place(generator), place(generator), 20.0 + 0.3 * place(generator)});
        const bool fades = is_translucent && generator() % 2 == 0;
        for (const int value : {int(generator() % 3) * 100, 0, 50, fades ? 128 : 255})
            colors.push_back(static_cast<uint8_t>(value));
    }
    // Many in one place: more than the stencil counts at once.
    for (int i = 0; i < 300; ++i) {
        places.push_back({400.0, 400.0, 50.0});
        colors.insert(colors.end(), {9, 9, 9, 255});
    }
    const Layer layer = squares(places, colors);
    const auto prepared = prepare(ground, layer);
    CHECK(prepared->groups.size() < places.size() / 2);
    for (int i = 0; i < 300; ++i) {
        const LatticePoint p = at(ground, place(generator), place(generator));
        // What laying the decals one by one leaves, and what the groups do: an opaque group once, however many cover.
        std::vector<Color> expected, found;
        for (uint32_t decal = 0; decal < places.size(); ++decal) {
            if (!prepared->volumes[decal].box.holds(p))
                continue;
            const Color& color = prepared->looks[decal].color;
            if (color[3] == 255)
                expected.clear();
            expected.push_back(color);
        }
        for (const auto& [group, batches] : counted(*prepared, p)) {
            const Color& color = prepared->groups[group];
            for (const auto& batch : batches) {
                REQUIRE(batch.second.size() <= (color[3] == 255 ? 255U : 127U));
                for (const uint32_t decal : batch.second)
                    REQUIRE(prepared->looks[decal].color == color);
            }
            if (color[3] == 255)
                found.clear();
            found.push_back(color);
        }
        REQUIRE(found == expected);
    }
}

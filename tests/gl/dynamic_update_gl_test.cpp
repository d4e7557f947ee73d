// The update of indices of dynamic lines against the same on the CPU, and against what no update may leave out.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <set>

#include "decalgl/core/error.h"
#include "dynamic_lines_case.h"

using namespace decalgl;
using namespace decalgl::test;

namespace {

using SegmentOfFour = std::array<uint32_t, 4>;

class UpdateCase : public MatchedCase {
public:
    using MatchedCase::MatchedCase;

    std::vector<SegmentOfFour> run(double cell, LineReach reach) {
        SegmentUpdate update(matched(), cell, {lowest, highest}, memory());
        const SegmentList& list = update.run(view(), reach, programs());
        kept = update.kept_vertices();
        const auto words = list.count.read<uint32_t>();
        std::vector<SegmentOfFour> segments(words.at(0));
        list.segments.buffer().read(0, segments.size() * sizeof(SegmentOfFour), segments.data());
        gl::check_errors("updating segments");
        return segments;
    }

    uint32_t kept = 0;
};

// Algorithm 3.2, mended: the vertices that are left of a line.
std::vector<uint32_t> simplified(const UpdateCase& scene, const LineRecord& line, double cell) {
    std::vector<uint32_t> left;
    for (uint32_t v = line.first; v < line.first + line.count; ++v) {
        const bool is_end = v == line.first || v + 1 == line.first + line.count;
        const auto cell_of = [&](uint32_t vertex) {
            const glm::vec2 place = scene.pixel(scene.clip(vertex)) / static_cast<float>(cell);
            return std::pair(std::floor(place.x), std::floor(place.y));
        };
        const auto known = [&](uint32_t vertex) {
            const glm::vec4 clip = scene.clip(vertex);
            const glm::vec2 place = glm::abs(scene.pixel(clip)) / static_cast<float>(cell);
            return clip.w > 0.0F && place.x < 2097152.0F && place.y < 2097152.0F;
        };
        if (is_end || cell == 0.0 || !known(v) || !known(v - 1) || cell_of(v) != cell_of(v - 1))
            left.push_back(v);
    }
    return left;
}

// Whether anything of the curtain above and below a segment is within the picture and its margin, by many points.
bool shows(const UpdateCase& scene, uint32_t from, uint32_t to, const LineLattice& lattice, glm::vec2 size,
           float reach_px) {
    const glm::dvec2 a(lattice.x_of(scene.vertices[from].place), lattice.y_of(scene.vertices[from].place));
    const glm::dvec2 b(lattice.x_of(scene.vertices[to].place), lattice.y_of(scene.vertices[to].place));
    for (int i = 0; i <= 40; ++i) {
        const glm::dvec2 at = a + (b - a) * (i / 40.0);
        for (int k = 0; k <= 8; ++k) {
            const glm::vec4 clip = scene.clip(at.x, at.y, lowest + (highest - lowest) * (k / 8.0));
            const glm::vec2 place = glm::abs(scene.pixel(clip));
            if (clip.w > 1e-3F && place.x < 0.5F * size.x + reach_px && place.y < 0.5F * size.y + reach_px)
                return true;
        }
    }
    return false;
}

}  // namespace

TEST_CASE("without cells, a view from above keeps every segment, with its neighbours") {
    const std::vector<LineInput> lines = wandering_lines(1, 200);
    UpdateCase scene(lines);
    scene.look(camera_at(middle + glm::dvec3(0, 0, 5000), middle, 1200.0), 400, 400);
    const std::vector<SegmentOfFour> segments = scene.run(0.0, {});
    CHECK(scene.kept == scene.vertices.size());
    size_t at = 0;
    for (const LineRecord& line : scene.records) {
        const bool closed = line.flags == LINE_CLOSED && line.count > 2;
        const uint32_t last = line.first + line.count - 1;
        for (uint32_t v = line.first; v < last; ++v) {
            const uint32_t previous = v > line.first ? v - 1 : closed ? last - 1 : NO_VERTEX;
            const uint32_t next = v + 1 < last ? v + 2 : closed ? line.first + 1 : NO_VERTEX;
            REQUIRE(at < segments.size());
            REQUIRE(segments[at++] == SegmentOfFour{previous, v, v + 1, next});
        }
    }
    CHECK(at == segments.size());
}

TEST_CASE("vertices in one cell of the screen are one, in all views, as on the CPU") {
    UpdateCase scene(wandering_lines(2, 400));
    for (const double cell : {0.125, 1.0, 16.0}) {
        for (const Camera& camera : cameras()) {
            scene.look(camera, 640, 360);
            // A reach over everything: nothing is culled that is not behind the camera.
            const std::vector<SegmentOfFour> segments = scene.run(cell, {1e6F, 1e6F});
            size_t expected = 0, at = 0, differing = 0;
            for (const LineRecord& line : scene.records) {
                const std::vector<uint32_t> left = simplified(scene, line, cell);
                expected += left.size();
                const auto stands = [&](uint32_t v) {
                    return v >= line.first && v < line.first + line.count;
                };
                std::set<uint32_t> drawn;
                for (; at < segments.size() && stands(segments[at][1]); ++at)
                    drawn.insert({segments[at][1], segments[at][2]});
                std::vector<uint32_t> missed;
                std::set_symmetric_difference(drawn.begin(), drawn.end(), left.begin(), left.end(),
                                              std::back_inserter(missed));
                differing += missed.size();
            }
            CHECK(at == segments.size());
            // A vertex on a cell's border may fall to either side by rounding.
            CHECK(differing <= scene.vertices.size() / 1000);
            CHECK(std::abs(static_cast<double>(expected) - scene.kept) <= scene.vertices.size() / 1000.0);
        }
    }
}

TEST_CASE("a line keeps its ends and its trace, however small it is") {
    const glm::dvec3 at = middle + glm::dvec3(0.0, 0.0, 5.0);
    std::vector<LineInput> lines;
    for (int i = 0; i < 70; ++i) {
        // Ends of lines and beginnings of the next fall into one cell, which must not join them.
        const double step = 1e-3 * i;
        lines.push_back({{at, at + glm::dvec3(step, 0, 0), at + glm::dvec3(2 * step, 0, 0)}, false});
        lines.push_back({{at, at + glm::dvec3(step, 0, 0), at + glm::dvec3(0, step, 0), at}, true});
    }
    UpdateCase scene(lines);
    scene.look(camera_at(middle + glm::dvec3(0, 0, 3000), middle), 300, 300);
    const std::vector<SegmentOfFour> segments = scene.run(1.0, {});
    REQUIRE(segments.size() == lines.size());
    for (size_t i = 0; i < lines.size(); ++i) {
        const LineRecord& line = scene.records[i];
        CHECK(segments[i] == SegmentOfFour{NO_VERTEX, line.first, line.first + line.count - 1, NO_VERTEX});
    }
}

TEST_CASE("closed lines stay closed when vertices go") {
    // A square of four sides with many vertices each: after simplification each side has a few, and the ring closes.
    LineInput ring;
    ring.closed = true;
    const glm::dvec3 corner[] = {
        {-100, -100, 5}, {100, -100, 5}, {100, 100, 5}, {-100, 100, 5}, {-100, -100, 5}};
    for (int side = 0; side < 4; ++side)
        for (int i = 0; i < 1000; ++i)
            ring.vertices.push_back(middle + corner[side] + (corner[side + 1] - corner[side]) * (i / 1000.0));
    ring.vertices.push_back(ring.vertices.front());
    UpdateCase scene({ring});
    scene.look(camera_at(middle + glm::dvec3(0, 0, 1000), middle), 200, 200);
    const std::vector<SegmentOfFour> segments = scene.run(8.0, {});
    REQUIRE(segments.size() > 8);
    REQUIRE(segments.size() < 100);
    const size_t count = segments.size();
    for (size_t i = 0; i + 1 < count; ++i) {
        CHECK(segments[i][2] == segments[i + 1][1]);
        CHECK(segments[i][3] == segments[i + 1][2]);
        CHECK(segments[i + 1][0] == segments[i][1]);
    }
    CHECK(segments[0][1] == 0);
    CHECK(segments[count - 1][2] == 4000);
    CHECK(segments[0][0] == segments[count - 1][1]);
    CHECK(segments[count - 1][3] == segments[0][2]);
}

TEST_CASE("culling leaves out nothing that may show, and most of what cannot") {
    UpdateCase scene(wandering_lines(3, 500));
    const LineLattice lattice = LineLattice::over({500000.0, 4000000.0, 501000.0, 4001000.0});
    size_t in_all = 0, in_views = 0;
    for (const Camera& camera : cameras()) {
        scene.look(camera, 320, 200);
        std::set<std::pair<uint32_t, uint32_t>> kept;
        for (const SegmentOfFour& segment : scene.run(0.0, {5.0F, 0.0F}))
            kept.insert({segment[1], segment[2]});
        for (const LineRecord& line : scene.records) {
            for (uint32_t v = line.first; v + 1 < line.first + line.count; ++v) {
                if (shows(scene, v, v + 1, lattice, {320, 200}, 5.0F))
                    REQUIRE(kept.count({v, v + 1}) == 1);
            }
        }
        in_all += scene.vertices.size() - scene.records.size();
        in_views += kept.size();
    }
    CHECK(in_views < in_all / 2);
}

TEST_CASE("a segment that crosses the view with both ends outside stays") {
    const LineInput across{{middle + glm::dvec3(-450, 40, 5), middle + glm::dvec3(450, 40, 5)}, false};
    const LineInput beside{{middle + glm::dvec3(-450, 40, 5), middle + glm::dvec3(-300, 40, 5)}, false};
    UpdateCase scene({across, beside});
    scene.look(camera_at(middle + glm::dvec3(0, -60, 100), middle + glm::dvec3(0, 40, 0)), 200, 200);
    const std::vector<SegmentOfFour> segments = scene.run(0.125, {});
    REQUIRE(segments.size() == 1);
    CHECK(segments[0] == SegmentOfFour{NO_VERTEX, 0, 1, NO_VERTEX});
    scene.look(camera_at(middle + glm::dvec3(0, -60, 100), middle + glm::dvec3(0, -200, 0)), 200, 200);
    CHECK(scene.run(0.125, {}).empty());
}

TEST_CASE("an update past the budget is an error that says so, and the next one is whole") {
    UpdateCase scene(wandering_lines(4, 300));
    scene.look(cameras()[0], 300, 200);
    const std::vector<SegmentOfFour> whole = scene.run(0.125, {});
    CHECK(whole.size() > 1000);
    scene.memory().set_budget(scene.memory().total() + 20000);
    try {
        scene.run(0.125, {});
        FAIL("no error");
    } catch (const Error& error) {
        CHECK(error.kind() == ErrorKind::memory);
        CHECK_THAT(error.what(), Catch::Contains("dynamic"));
    }
    scene.memory().set_budget(0);
    CHECK(scene.run(0.125, {}) == whole);
}

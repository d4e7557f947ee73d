#pragma once

// Lines of dynamic layers on the ground as they are after matching, and views of them.

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <random>
#include <vector>

#include "frame/view_setup.h"
#include "gl/texture.h"
#include "gl_fixture.h"
#include "shared/view_block.h"
#include "technique/dynamic_lines/update_segments.h"

namespace decalgl::test {

constexpr float lowest = -20.0F;
constexpr float highest = 60.0F;

using Line = std::vector<glm::dvec3>;
struct LineInput {
    Line vertices;
    bool closed = false;  // then the last vertex repeats the first
};

class MatchedCase {
public:
    explicit MatchedCase(const std::vector<LineInput>& lines) {
        const Bounds bounds = terrain_.bounds();
        positions_ = PositionGrid::around(bounds);
        matched_.lattice = LineLattice::over(bounds);
        for (const LineInput& line : lines) {
            records.push_back({static_cast<uint32_t>(vertices.size()),
                               static_cast<uint32_t>(line.vertices.size()),
                               static_cast<uint32_t>(records.size()), line.closed ? LINE_CLOSED : 0U});
            for (const glm::dvec3& v : line.vertices)
                vertices.push_back({matched_.lattice.place(v.x, v.y), static_cast<float>(v.z),
                                    static_cast<uint32_t>(records.size() - 1)});
        }
        matched_.vertices = gl::TextureBuffer::from(memory_, "vertices", GL_RGBA32UI, vertices);
        matched_.lines = gl::TextureBuffer::from(memory_, "lines", GL_RGBA32UI, records);
        matched_.vertex_count = static_cast<uint32_t>(vertices.size());
        matched_.line_count = static_cast<uint32_t>(records.size());
        matched_.segment_count = matched_.vertex_count - matched_.line_count;
        ground_ = gl::Texture2D::create(memory_, "ground", GL_R32F, 2, 2);
        ground_.update(0, 0, 0, 2, 2, terrain_.heights().data());
        matched_.ground = &ground_;
    }

    void look(const Camera& camera, int width, int height) {
        width_ = width;
        height_ = height;
        block_ = make_view_block(camera, width, height, terrain_, positions_, 0.0);
        buffer_ = gl::Buffer::create(memory_, "view", sizeof(ViewBlock), &block_);
        buffer_.bind_base(GL_UNIFORM_BUFFER, 0);
    }

    View view() const {
        View view{width_, height_, positions_};
        view.block = &block_;
        return view;
    }

    glm::vec4 clip(uint32_t vertex) const {
        const MatchedVertex& v = vertices[vertex];
        return clip(matched_.lattice.x_of(v.place), matched_.lattice.y_of(v.place), double{v.height});
    }

    glm::vec4 clip(double x, double y, double z) const {
        const glm::dvec3 base(
            positions_.origin_x + block_.base_block.x * positions_.block_size + double{block_.base_offset.x},
            positions_.origin_y + block_.base_block.y * positions_.block_size + double{block_.base_offset.y},
            double{block_.base_sample_fraction.z} + double{block_.base_sample_fraction.w});
        return block_.clip_from_base * glm::vec4(glm::vec3(glm::dvec3(x, y, z) - base), 1.0F);
    }

    glm::vec2 pixel(glm::vec4 clip) const {
        return 0.5F * glm::vec2(clip.x / clip.w * static_cast<float>(width_),
                                clip.y / clip.w * static_cast<float>(height_));
    }

    std::vector<MatchedVertex> vertices;
    std::vector<LineRecord> records;

    MemoryAccount& memory() { return memory_; }
    const MatchedLines& matched() const { return matched_; }
    // Of the samples in the north-west, north-east, south-west and south-east.
    void set_ground(const std::array<float, 4>& heights) { ground_.update(0, 0, 0, 2, 2, heights.data()); }
    const ViewBlock& block() const { return block_; }
    gl::ProgramLibrary& programs() { return programs_; }

private:
    gl::Context& context_ = test::test_context();
    MemoryAccount memory_;
    Heightfield terrain_{
        std::vector<float>{lowest, highest, 0.0F, 10.0F}, 2, 2, 500000.0, 4001000.0, 1000.0, 1000.0};
    PositionGrid positions_;
    gl::Texture2D ground_;
    MatchedLines matched_;
    ViewBlock block_{};
    gl::Buffer buffer_;
    gl::ProgramLibrary programs_;
    int width_ = 0;
    int height_ = 0;
};

inline Camera camera_at(glm::dvec3 eye, glm::dvec3 target, double view_height = 0.0) {
    Camera camera;
    camera.eye = eye;
    camera.target = target;
    camera.view_height = view_height;
    return camera;
}

inline const glm::dvec3 middle(500500.0, 4000500.0, 0.0);

inline const std::vector<Camera>& cameras() {
    static const std::vector<Camera> all = {
        camera_at(middle + glm::dvec3(0, -1200, 900), middle),
        camera_at(middle + glm::dvec3(0, -300, 12), middle + glm::dvec3(0, 0, 8)),
        camera_at(middle + glm::dvec3(5, 3, 70), middle + glm::dvec3(5, 20, 0)),
        camera_at(middle + glm::dvec3(0, -600, 500), middle, 400.0),
    };
    return all;
}

// Wandering lines with vertices from far apart to on top of each other, some closed.
inline std::vector<LineInput> wandering_lines(unsigned seed, int count) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> at(0.0, 1000.0), turn(-0.6, 0.6);
    std::vector<LineInput> lines;
    for (int i = 0; i < count; ++i) {
        LineInput line;
        const double step = std::pow(10.0, std::uniform_real_distribution<double>(-3.0, 2.0)(random));
        const int vertices = std::uniform_int_distribution<int>(2, 90)(random);
        double direction = at(random);
        glm::dvec3 place(500000.0 + at(random), 4000000.0 + at(random), 5.0);
        for (int k = 0; k < vertices; ++k) {
            line.vertices.push_back(place);
            direction += turn(random);
            place.x = std::clamp(place.x + step * std::cos(direction), 500000.0, 501000.0);
            place.y = std::clamp(place.y + step * std::sin(direction), 4000000.0, 4001000.0);
            place.z = 20.0 * std::sin(0.01 * place.x) + 10.0;
        }
        line.closed = i % 3 == 0;
        if (line.closed)
            line.vertices.push_back(line.vertices.front());
        lines.push_back(line);
    }
    return lines;
}

}  // namespace decalgl::test

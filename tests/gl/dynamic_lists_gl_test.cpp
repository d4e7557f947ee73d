// Lists of lines at each pixel against distances and compositing in double precision, on a plane.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "decalgl/core/error.h"
#include "dynamic_lines_case.h"
#include "gl/readback.h"
#include "gl/texture.h"
#include "technique/dynamic_lines/lists.h"

using namespace decalgl;
using namespace decalgl::test;
using glm::dvec2;
using glm::dvec3;

namespace {

constexpr double ambiguous = 0.02;  // pixels from a border, on which rounding may decide

struct Plane {
    dvec2 gradient{0.0};

    double height(dvec2 place) const { return glm::dot(gradient, place - dvec2(middle)); }
};

struct Rgba {
    uint32_t r, g, b, a;
};

class ListCase : public MatchedCase {
public:
    ListCase(std::vector<LineInput> lines, Plane plane) : MatchedCase(on_plane(lines, plane)), plane_(plane) {
        const auto at = [&](double x, double y) { return static_cast<float>(plane.height(dvec2(x, y))); };
        set_ground({at(500000, 4001000), at(501000, 4001000), at(500000, 4000000), at(501000, 4000000)});
    }

    void style(double half_width, const std::vector<Rgba>& colors) {
        half_width_ = half_width;
        PreparedLines prepared;
        std::vector<LineStyle> styles;
        for (size_t i = 0; i < records.size(); ++i) {
            const Rgba c = colors[i % colors.size()];
            colors_.push_back(c);
            LineStyle style{};
            style.color = c.r | c.g << 8 | c.b << 16 | c.a << 24;
            style.half_width = static_cast<float>(half_width);
            style.most_px = style.most_metres = std::numeric_limits<float>::infinity();
            styles.push_back(style);
        }
        prepared.styles = SharedArray<LineStyle>(styles);
        prepared.lines = SharedArray<LineRecord>(records);
        prepared.summarise();
        looks_.upload(prepared, nullptr, memory());
    }

    void look(const Camera& camera, int width, int height) {
        MatchedCase::look(camera, width, height);
        width_ = width;
        height_ = height;
        perspective_ = camera.view_height == 0.0;
        std::vector<glm::vec4> surface;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                surface.emplace_back(glm::vec2(plane_.gradient), distance(centre(x, y)), 1.0F);
        surface_ = gl::Texture2D::create(memory(), "surface", GL_RGBA32F, width, height);
        surface_.update(0, 0, 0, width, height, surface.data());
        color_ = gl::Texture2D::create(memory(), "color", GL_RGBA8, width, height);
        id_ = gl::Texture2D::create(memory(), "id", GL_R32UI, width, height);
        colors_framebuffer_ = gl::Framebuffer::create("color", {{GL_COLOR_ATTACHMENT0, &color_}});
        ids_framebuffer_ = gl::Framebuffer::create("id", {{GL_COLOR_ATTACHMENT0, &id_}});
    }

    std::vector<uint8_t> draw(LineLists& lists, LineWidthRule rule) {
        prepare_to_draw();
        colors_framebuffer_.bind();
        lists.draw(view(), gbuffer_, listed(rule), programs());
        gl::check_errors("drawing lists");
        return gl::read_pixels<uint8_t>(colors_framebuffer_, GL_COLOR_ATTACHMENT0, 0, 0, width_, height_,
                                        gl::transfer_format(GL_RGBA8), 4);
    }

    std::vector<uint32_t> draw_ids(LineLists& lists, LineWidthRule rule) {
        prepare_to_draw();
        ids_framebuffer_.bind();
        lists.draw_ids(view(), gbuffer_, listed(rule), programs());
        gl::check_errors("drawing ids");
        return gl::read_pixels<uint32_t>(ids_framebuffer_, GL_COLOR_ATTACHMENT0, 0, 0, width_, height_,
                                         gl::transfer_format(GL_R32UI), 1);
    }

    struct Expected {
        bool is_certain = true;
        dvec3 color{0.0};  // premultiplied
        double alpha = 0.0;
        uint32_t id = 0;
    };

    Expected expected(int x, int y, LineWidthRule rule) const {
        Expected pixel;
        const dvec2 at = centre(x, y);
        if (distance(at) == std::numeric_limits<float>::infinity())
            return pixel;
        for (size_t i = records.size(); i-- > 0;) {
            const double beyond = beyond_border(records[i], at, rule);
            pixel.is_certain &= std::abs(beyond) > ambiguous;
            if (beyond > 0.0)
                continue;
            const Rgba c = colors_[i];
            const double weight = (1.0 - pixel.alpha) * (c.a / 255.0);
            pixel.color += weight * dvec3(c.r, c.g, c.b);
            pixel.alpha += weight;
            if (pixel.id == 0)
                pixel.id = static_cast<uint32_t>(i) + 1;
        }
        return pixel;
    }

    // Pixels that differ from what is expected, of those that are certain.
    int mistakes(LineLists& lists, LineWidthRule rule) {
        const std::vector<uint8_t> colors = draw(lists, rule);
        const std::vector<uint32_t> ids = draw_ids(lists, rule);
        int wrong = 0, uncertain = 0, covered = 0;
        for (int y = 0; y < height_; ++y) {
            for (int x = 0; x < width_; ++x) {
                const Expected pixel = expected(x, y, rule);
                const size_t i =
                    static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x);
                covered += pixel.id != 0;
                uncertain += !pixel.is_certain;
                if (!pixel.is_certain)
                    continue;
                bool same = ids[i] == pixel.id && std::abs(colors[4 * i + 3] - 255.0 * pixel.alpha) < 1.5;
                for (int k = 0; k < 3; ++k)
                    same &= std::abs(colors[4 * i + static_cast<size_t>(k)] - pixel.color[k]) < 1.5;
                wrong += !same;
            }
        }
        CHECK(covered > width_ * height_ / 100);
        CHECK(covered < width_ * height_);
        CHECK(uncertain < width_ * height_ / 10);
        return wrong;
    }

    ListedLines listed(LineWidthRule rule) const {
        const double rise = 600.0 * (std::abs(plane_.gradient.x) + std::abs(plane_.gradient.y)) + 1.0;
        return {&matched(), segments_, &looks_, rule, glm::vec2(-rise, rise)};
    }

private:
    static std::vector<LineInput> on_plane(std::vector<LineInput> lines, Plane plane) {
        for (LineInput& line : lines)
            for (dvec3& v : line.vertices)
                v.z = plane.height(dvec2(v));
        return lines;
    }

    void prepare_to_draw() {
        update_ = std::make_unique<SegmentUpdate>(matched(), 0.0,
                                                  listed(LineWidthRule::screen).ground_heights, memory());
        segments_ = &update_->run(view(), {1e5F, 1e5F}, programs());
        gbuffer_.surface = &surface_;
    }

    dvec2 centre(int x, int y) const { return {x + 0.5 - 0.5 * width_, y + 0.5 - 0.5 * height_}; }

    dvec3 base() const {
        const View seen = view();
        const ViewBlock& b = block();
        return {
            seen.positions.origin_x + b.base_block.x * seen.positions.block_size + double{b.base_offset.x},
            seen.positions.origin_y + b.base_block.y * seen.positions.block_size + double{b.base_offset.y},
            double{b.base_sample_fraction.z} + double{b.base_sample_fraction.w}};
    }

    dvec3 origin(dvec2 at) const {
        return at.x * dvec3(block().ray_origin_dx) + at.y * dvec3(block().ray_origin_dy);
    }

    dvec3 direction(dvec2 at) const {
        return dvec3(block().ray_direction) + at.x * dvec3(block().ray_direction_dx) +
               at.y * dvec3(block().ray_direction_dy);
    }

    // Along the ray to the plane; infinite where it meets none.
    float distance(dvec2 at) const {
        const dvec3 from = base() + origin(at), way = direction(at);
        const dvec2 g = plane_.gradient;
        const double t = (plane_.height(dvec2(from)) - from.z) / (way.z - glm::dot(g, dvec2(way)));
        return t > 0.0 && t < 5000.0 ? static_cast<float>(t) : std::numeric_limits<float>::infinity();
    }

    double beyond_border(const LineRecord& line, dvec2 at, LineWidthRule rule) const {
        double least = std::numeric_limits<double>::infinity();
        const dvec3 ground = base() + origin(at) + static_cast<double>(distance(at)) * direction(at);
        const double scale = perspective_ ? glm::length(dvec3(block().ray_direction_dx)) : 0.0;
        const double pixel =
            perspective_ ? scale * glm::length(ground - (base() - static_cast<double>(block().forward.w) *
                                                                      dvec3(block().forward)))
                         : glm::length(dvec3(block().ray_origin_dx));
        for (uint32_t v = line.first; v + 1 < line.first + line.count; ++v) {
            const bool by_thesis = rule == LineWidthRule::thesis;
            const dvec2 a = place(v), b = place(v + 1);
            least =
                std::min(least, by_thesis ? to_segment(dvec2(ground), a, b) / pixel : on_screen(at, a, b));
        }
        return least - half_width_;
    }

    dvec2 place(uint32_t vertex) const {
        return {matched().lattice.x_of(vertices[vertex].place),
                matched().lattice.y_of(vertices[vertex].place)};
    }

    static double to_segment(dvec2 point, dvec2 a, dvec2 b) {
        const dvec2 way = b - a;
        const double share =
            std::clamp(glm::dot(point - a, way) / std::max(glm::dot(way, way), 1e-300), 0.0, 1.0);
        return glm::length(a + share * way - point);
    }

    double on_screen(dvec2 at, dvec2 a, dvec2 b) const {
        const auto project = [&](dvec2 place) {
            const glm::dmat4 matrix(block().clip_from_base);
            return matrix * glm::dvec4(dvec3(place, plane_.height(place)) - base(), 1.0);
        };
        glm::dvec4 from = project(a), to = project(b);
        const double near = 0.05;
        if (from.w < near && to.w < near)
            return std::numeric_limits<double>::infinity();
        const glm::dvec4 cut = from + (to - from) * ((near - from.w) / (to.w - from.w));
        if (from.w < near)
            from = cut;
        if (to.w < near)
            to = cut;
        const dvec2 half(0.5 * width_, 0.5 * height_);
        return to_segment(at, half * dvec2(from) / from.w, half * dvec2(to) / to.w);
    }

    Plane plane_;
    double half_width_ = 0.0;
    std::vector<Rgba> colors_;
    LineLooks looks_;
    std::unique_ptr<SegmentUpdate> update_;
    const SegmentList* segments_ = nullptr;
    gl::Texture2D surface_, color_, id_;
    gl::Framebuffer colors_framebuffer_, ids_framebuffer_;
    GBufferView gbuffer_;
    bool perspective_ = true;
    int width_ = 0;
    int height_ = 0;
};

const std::vector<Rgba> opaque = {{255, 0, 0, 255}, {0, 200, 0, 255}, {0, 0, 255, 255}, {250, 240, 0, 255}};
const std::vector<Rgba> translucent = {
    {255, 0, 0, 128}, {0, 200, 0, 60}, {0, 0, 255, 255}, {250, 240, 0, 90}};

}  // namespace

TEST_CASE("lists hold each line that covers a pixel, in draw order, in all views and by both rules") {
    for (const Plane plane : {Plane{}, Plane{{0.5, -0.3}}}) {
        for (const LineWidthRule rule : {LineWidthRule::screen, LineWidthRule::thesis}) {
            std::vector<LineInput> lines = wandering_lines(7, 24);
            lines.push_back(
                {{middle + dvec3(-60, -45, 0), middle + dvec3(5, 20, 0), middle + dvec3(60, 30, 0)}, false});
            ListCase scene(lines, plane);
            scene.style(2.6, rule == LineWidthRule::screen ? opaque : translucent);
            LineLists lists(scene.memory());
            for (const Camera& camera : cameras()) {
                INFO("slope " << plane.gradient.x << ", rule " << static_cast<int>(rule) << ", eye "
                              << camera.eye.x - middle.x << " " << camera.eye.y - middle.y);
                scene.look(camera, 48, 36);
                CHECK(scene.mistakes(lists, rule) == 0);
            }
        }
    }
}

TEST_CASE("without room at first, lists grow until nothing is left out") {
    ListCase scene(wandering_lines(8, 60), {});
    scene.style(4.0, translucent);
    scene.look(cameras()[0], 120, 80);
    LineLists small(scene.memory(), 1), large(scene.memory(), 1 << 20);
    CHECK(scene.draw(small, LineWidthRule::screen) == scene.draw(large, LineWidthRule::screen));
    CHECK(small.entries() > 1000);
    CHECK(small.entries() == large.entries());
    CHECK(small.bytes() < large.bytes());
    // Half as many again fit without another try, and later pictures may need less.
    scene.look(cameras()[3], 60, 40);
    CHECK(scene.draw(small, LineWidthRule::screen) == scene.draw(large, LineWidthRule::screen));
}

TEST_CASE("lists longer than a run of the shader may walk are sorted in several") {
    std::vector<LineInput> lines;
    for (int i = 0; i < 700; ++i) {
        // Up and back again: each line is there more than once, and counts once.
        const dvec3 aside(0.01 * (i % 10), 0.0, 0.0);
        lines.push_back(
            {{middle - dvec3(0, 30, 0) + aside, middle + dvec3(0, 30, 0) + aside, middle - dvec3(0, 30, 0)},
             false});
    }
    std::reverse(lines.begin(), lines.end());
    ListCase scene(lines, {});
    std::vector<Rgba> faint;
    for (uint32_t i = 0; i < 700; ++i)
        faint.push_back({i % 256, 255 - i % 256, (7 * i) % 256, 3});
    scene.style(3.0, faint);
    scene.look(camera_at(middle + dvec3(0, 0, 50), middle, 20.0), 24, 20);
    LineLists lists(scene.memory());
    CHECK(scene.mistakes(lists, LineWidthRule::screen) == 0);
}

TEST_CASE("more segments at a pixel than a shader can walk are an error that says what to do") {
    LineInput line;
    for (int i = 0; i < 60100; ++i)
        line.vertices.push_back(middle + dvec3(0.0, i % 2, 0.0));
    ListCase scene({line}, {});
    scene.style(2.0, opaque);
    scene.look(camera_at(middle + dvec3(0, 0, 50), middle, 20.0), 3, 3);
    LineLists lists(scene.memory());
    CHECK_THROWS_WITH(scene.draw(lists, LineWidthRule::screen), Catch::Contains("bins"));
}

TEST_CASE("lists past the budget are an error, and the next picture is whole") {
    ListCase scene(wandering_lines(9, 60), {});
    scene.style(4.0, opaque);
    scene.look(cameras()[0], 100, 80);
    LineLists lists(scene.memory(), 1);
    const std::vector<uint8_t> whole = scene.draw(lists, LineWidthRule::screen);
    LineLists others(scene.memory(), 1);
    scene.memory().set_budget(scene.memory().total() + 150000);
    try {
        scene.draw(others, LineWidthRule::screen);
        FAIL("no error");
    } catch (const Error& error) {
        CHECK(error.kind() == ErrorKind::memory);
        CHECK_THAT(error.what(), Catch::Contains("dynamic: lists"));
    }
    scene.memory().set_budget(0);
    CHECK(scene.draw(others, LineWidthRule::screen) == whole);
}

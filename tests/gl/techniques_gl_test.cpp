// Layers of several techniques in one scene: each run of neighbours is a pass over those below.
#include <catch2/catch.hpp>

#include <cmath>

#include "decalgl/core/error.h"
#include "decalgl/frame/renderer.h"
#include "error_kind.h"

using namespace decalgl;
using namespace decalgl::test;

namespace {

Layer square(double x, double y, double side, std::vector<uint8_t> color, const char* technique) {
    Layer layer;
    layer.name = technique;
    layer.technique.name = technique;
    layer.features = Features::own(FeatureKind::polygons,
                                   {x, y, x + side, y, x + side, y + side, x, y + side}, {0, 4}, {0, 1}, {7});
    layer.fill.colors = std::move(color);
    return layer;
}

// Squares that overlap, drawn by these techniques from bottom to top.
Scene stack(const std::vector<const char*>& techniques) {
    Scene scene;
    scene.terrain = Heightfield({0, 5, 0, 5, 9, 5, 0, 5, 0}, 3, 3, 0.0, 100.0, 50.0, 50.0);
    const std::vector<std::vector<uint8_t>> colors{
        {200, 30, 30, 255}, {30, 200, 30, 128}, {30, 30, 200, 200}, {200, 200, 30, 255}};
    for (size_t i = 0; i < techniques.size(); ++i) {
        const auto shift = 12.0 * static_cast<double>(i);
        scene.layers.push_back(square(10 + shift, 20 + 0.5 * shift, 40, colors[i], techniques[i]));
    }
    return scene;
}

RendererOptions with(Antialias antialias) {
    RendererOptions options;
    options.width = options.height = 96;
    options.antialias = antialias;
    return options;
}

Frame draw(Renderer& renderer, const Scene& scene) {
    renderer.preprocess(scene);
    renderer.update(Camera::orbit({50.0, 50.0, 0.0}, 120.0, 200.0, 50.0));
    return renderer.render();
}

int largest_difference(const Frame& a, const Frame& b) {
    int largest = 0;
    for (size_t i = 0; i < a.image().size(); ++i)
        largest = std::max(largest, std::abs(int{a.image()[i]} - int{b.image()[i]}));
    return largest;
}

const std::vector<const char*> one_pass{"static", "static", "static", "static"};
const std::vector<const char*> three_passes{"static", "static_bvh", "static_bvh", "static"};

}  // namespace

TEST_CASE("passes of several techniques lie over each other in the order of the layers") {
    const Antialias antialias = GENERATE(Antialias::none, Antialias::coverage, Antialias::ssaa);
    Renderer one(with(antialias)), three(with(antialias));
    const Frame expected = draw(one, stack(one_pass)), mixed = draw(three, stack(three_passes));
    // Each pass rounds its colours to 8 bits; edges of different passes do not know of each other.
    CHECK(largest_difference(expected, mixed) <= (antialias == Antialias::coverage ? 40 : 2));
    CHECK(mixed.ids() == expected.ids());
    CHECK(mixed.layers() == expected.layers());
    const auto layers_at = [](const Frame& frame, int x, int y) {
        std::vector<int32_t> layers;
        for (const PickedFeature& picked : frame.pick(x, y))
            layers.push_back(picked.layer);
        return layers;
    };
    for (int y = 4; y < 96; y += 8)
        for (int x = 4; x < 96; x += 8)
            CHECK(layers_at(mixed, x, y) == layers_at(expected, x, y));
}

TEST_CASE("a restyle reaches the pass of its layer alone") {
    Renderer one(with(Antialias::none)), three(with(Antialias::none));
    draw(one, stack(one_pass));
    draw(three, stack(three_passes));
    LayerLook look;
    look.layer = 3;
    look.fill.colors = {10, 220, 220, 255};
    one.restyle({look});
    three.restyle({look});
    CHECK(largest_difference(one.render(), three.render()) <= 2);
    CHECK(three.look(3).fill.colors == look.fill.colors);
    look.layer = 1;
    one.restyle({look});
    three.restyle({look});
    CHECK(largest_difference(one.render(), three.render()) <= 2);
}

TEST_CASE("a layer of no technique is refused by name") {
    Renderer renderer(with(Antialias::none));
    CHECK(kind_of([&] { renderer.preprocess(stack({"statik"})); }) == ErrorKind::input);
}

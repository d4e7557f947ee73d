// Forged files, drawn: whatever the arrays of a file hold that opening accepts, a picture comes of it.
#include <catch2/catch.hpp>

#include "decalgl/core/error.h"
#include "decalgl/frame/renderer.h"
#include "error_kind.h"
#include "forged_archive.h"

using namespace decalgl;
using namespace decalgl::test;

namespace {

Scene sample_scene() {
    Scene scene;
    scene.terrain = Heightfield({0, 5, 0, 5, 9, 5, 0, 5, 0}, 3, 3, 0.0, 100.0, 50.0, 50.0);
    Layer area;
    area.name = "area";
    area.features =
        Features::own(FeatureKind::polygons, {10, 10, 90, 10, 90, 90, 10, 90}, {0, 4}, {0, 1}, {3});
    area.fill.colors = {200, 30, 30, 128};
    Layer way;
    way.name = "way";
    way.features = Features::own(FeatureKind::lines, {0, 0, 100, 100}, {0, 2}, {0, 1}, {8});
    way.stroke.colors = {30, 30, 200, 255};
    way.stroke.widths = {9.0};
    scene.layers = {area, way};
    return scene;
}

Frame draw(Renderer& renderer) {
    renderer.update(Camera::orbit({50.0, 50.0, 0.0}, 120.0, 200.0, 50.0));
    return renderer.render();
}

RendererOptions of_size(int side) {
    RendererOptions options;
    options.width = options.height = side;
    return options;
}

}  // namespace

TEST_CASE("a renderer that opens a file draws what the one that saved it drew") {
    const ScratchFolder folder;
    Renderer first(of_size(64)), second(of_size(64));
    CHECK(kind_of([&] { first.save(folder.file("map")); }) == ErrorKind::input);
    first.preprocess(sample_scene());
    first.save(folder.file("map"));
    second.open(folder.file("map"));
    std::filesystem::remove(folder.file("map"));
    const Frame saved = draw(first), opened = draw(second);
    CHECK(opened.image() == saved.image());
    CHECK(opened.ids() == saved.ids());
    CHECK(opened.layers() == saved.layers());
    CHECK(opened.stats().counts == saved.stats().counts);
    CHECK(opened.pick(32, 32).size() == 2);
    CHECK(second.layers()[1].name == "way");
    CHECK(second.bounds().max_x == 100.0);
}

TEST_CASE("forged files end in an error or in a picture") {
    const ScratchFolder folder;
    Renderer renderer(of_size(24));
    renderer.preprocess(sample_scene());
    renderer.save(folder.file("map"));
    const Bytes whole = read_file(folder.file("map"));
    std::mt19937 random(11);
    int drawn = 0;
    for (int trial = 0; trial < 60; ++trial) {
        write_file(folder.file("forged"), forge_contents(whole, random));
        try {
            renderer.open(folder.file("forged"));
            const Frame frame = draw(renderer);
            frame.ids();
            frame.pick(12, 12);
            ++drawn;
        } catch (const Error&) {
        }
    }
    CHECK(drawn > 5);
    renderer.preprocess(sample_scene());
    CHECK_FALSE(draw(renderer).pick(12, 12).empty());
}
